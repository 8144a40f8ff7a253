"""Short edges are contracted, and nothing else moves."""

from __future__ import annotations

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box

from printprep.mesh.measure import arrays
from printprep.mesh.self_intersections import self_intersections
from printprep.mesh.short_edges import contract_short_edges


def shortest(manifold: Manifold) -> float:
    vertices, faces = arrays(manifold)
    corners = vertices[faces]
    return float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).min())


def test_a_step_of_less_than_a_thousandth_is_gone():
    tower = box(10, 10, 10) + box(10, 10, 10).translate((0.0008, 0.0, 9.0))
    assert shortest(tower) < 0.001
    clean = contract_short_edges(tower, 0.002)
    assert shortest(clean) > 1
    assert clean.volume() == pytest.approx(1900, abs=0.1)
    assert clean.num_tri() == 12


def test_a_step_that_is_long_enough_stays():
    tower = box(10, 10, 10) + box(10, 10, 10).translate((0.003, 0.0, 9.0))
    assert contract_short_edges(tower, 0.002) is tower
    ball = Manifold.sphere(5, 64)
    assert contract_short_edges(ball, 0.002) is ball


@examples(15)
@given(st.lists(st.tuples(*[st.floats(-3, 3)] * 3), min_size=8, max_size=40))
def test_heaps_of_balls_lose_their_short_edges_and_stay_solids(places):
    heap = Manifold()
    for place in places:
        heap += Manifold.sphere(2, 24).translate(place)
    clean = contract_short_edges(heap.as_original(), 0.002)
    assert shortest(clean) >= 0.002
    # A handle no thicker than a short edge closes, as in three balls that all but touch.
    assert clean.genus() <= heap.genus()
    assert clean.volume() == pytest.approx(heap.volume(), rel=1e-4)
    assert len(self_intersections(*arrays(clean)).face) == 0
