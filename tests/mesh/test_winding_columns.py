"""Exact winding numbers along vertical lines, against boxes, the definition, and igl."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_bodies import box, inside_out, joined, sphere

from printprep.mesh.measure import winding
from printprep.mesh.winding_columns import crossings_of, winding_at


def scattered(low: float, high: float, count: int = 4000) -> np.ndarray:
    return np.random.default_rng(7).uniform(low, high, (count, 3))


def test_a_column_crosses_a_box_twice() -> None:
    found = crossings_of(*box((0, 0, 1), (2, 2, 4)), np.array([[0.3, 0.4], [5.0, 5.0], [1.7, 0.2]]))
    assert found.column.tolist() == [0, 0, 2, 2]
    assert found.z_mm.tolist() == [1, 4, 1, 4]
    assert found.sign.tolist() == [-1, 1, -1, 1]


def test_overlaps_count_twice_and_voids_not_at_all() -> None:
    boxes = [((0, 0, 0), (4, 4, 4)), ((3, 0, 0), (6, 4, 4)), ((1, 1, 1), (2, 2, 2))]
    mesh = joined(box(*boxes[0]), box(*boxes[1]), inside_out(box(*boxes[2])))
    points = scattered(-1, 7)
    one, two, void = (
        ((points > low) & (points < high)).all(axis=1).astype(float) for low, high in boxes
    )
    assert (winding_at(points, *mesh) == one + two - void).all()


def test_an_open_surface_agrees_with_solid_angles() -> None:
    vertices, faces = sphere(1.0, 3)
    cut = faces[vertices[faces][:, :, 2].min(axis=1) > -0.6]
    points = scattered(-1.2, 1.2)
    w = winding_at(points, vertices, cut)
    assert ((w > 0.3) & (w < 0.7)).any()
    assert w == pytest.approx(winding(points, vertices, cut), abs=0.01)


@given(st.integers(0, 2**31))
def test_slivers_cost_no_accuracy(seed: int) -> None:
    """A closed fan of needles, turned at random: inside is inside."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * np.pi, 40))
    rim = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(40)])
    vertices = np.vstack([rim, [[0, 0, 30], [0, 0, -30]]])
    i, j = np.arange(40), np.roll(np.arange(40), -1)
    faces = np.vstack(
        [np.column_stack([i, j, np.full(40, 40)]), np.column_stack([j, i, np.full(40, 41)])]
    )
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn = q * np.sign(np.linalg.det(q))
    w = winding_at(rng.uniform(-30, 30, (500, 3)), vertices @ turn.T, faces)
    assert set(np.unique(w)) <= {0.0, 1.0}
    weights = rng.dirichlet(np.ones(len(vertices)), 200)
    # The polygon is convex when its rim holds the centre; only then are all mixtures inside.
    if np.diff(np.append(angle, angle[0] + 2 * np.pi)).max() < np.pi:
        assert (winding_at(weights @ vertices @ turn.T, vertices @ turn.T, faces) == 1).all()
