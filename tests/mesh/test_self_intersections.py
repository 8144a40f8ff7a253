"""Surfaces that pass through themselves, found everywhere and beside folds."""

from __future__ import annotations

import numpy as np
import pytest
from dev_hollowable import hollowable_of
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.mesh.measure import arrays
from printprep.mesh.self_intersections import folded, self_intersections
from printprep.profiles import load_profile


def ball_with_a_vertex_at(place: tuple[float, float, float]) -> tuple[np.ndarray, np.ndarray]:
    """A ball of radius 10 whose vertex nearest the top is moved."""
    vertices, faces = arrays(Manifold.sphere(10, 48))
    vertices = vertices.copy()
    vertices[vertices[:, 2].argmax()] = place
    return vertices, faces


@pytest.mark.parametrize(
    ("place", "through", "beside"),
    [
        ((0, 0, 10), False, False),
        ((0, 0, 12), False, False),  # a spike
        ((0, 0, 5), False, False),  # a dent
        ((0.3, 0.2, 9.99), False, False),  # aside, over its own triangles
        ((3, 0, 9), False, False),  # beyond them, under the surface there
        ((3, 0.1, 9.57), True, True),  # beyond them, over it
        ((0, 0, -12), True, False),  # out on the other side
    ],
)
def test_a_ball_with_one_vertex_moved(place, through, beside):
    vertices, faces = ball_with_a_vertex_at(place)
    assert (len(self_intersections(vertices, faces).face) > 0) == through
    assert folded(vertices, faces) == beside


@given(st.floats(-6, 6), st.floats(-6, 6), st.floats(-15, 15))
def test_a_folded_surface_intersects_itself(x, y, z):
    vertices, faces = ball_with_a_vertex_at((x, y, z))
    if folded(vertices, faces):
        assert len(self_intersections(vertices, faces).face) > 0


@pytest.mark.corpus
def test_a_hollowable_volume_does_not_fold_where_it_is_simplified(dev_models):
    """The teapot's did, 0.008 mm deep, at the foot of its handle."""
    teapot = dev_models["teapot"]
    _, hollowable_volume = hollowable_of(teapot.path, teapot.up, 100.0, load_profile("fdm-pla-0.4"))
    assert len(self_intersections(*arrays(hollowable_volume)).face) == 0
