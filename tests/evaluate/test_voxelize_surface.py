"""Voxels and triangles that meet, against clipping one by the other."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import box_arrays
from hypothesis import given
from hypothesis import strategies as st

from printprep.evaluate import voxelize_surface as room
from printprep.evaluate.voxelize_surface import voxelize_surface

EDGE = 6


def clipped(triangle: np.ndarray, low: np.ndarray) -> bool:
    """Whether anything of a triangle is left within [low, low + 1]³ (Sutherland & Hodgman)."""
    polygon = list(triangle)
    for axis in range(3):
        for sign, limit in ((1.0, low[axis]), (-1.0, -(low[axis] + 1.0))):
            kept = []
            for a, b in zip(polygon, polygon[1:] + polygon[:1], strict=True):
                da, db = sign * a[axis] - limit, sign * b[axis] - limit
                if da >= 0:
                    kept.append(a)
                if (da > 0 > db) or (da < 0 < db):
                    kept.append(a + (b - a) * da / (da - db))
            polygon = kept
    return bool(polygon)


@given(st.integers(0, 10_000))
def test_it_finds_what_clipping_finds(seed):
    rng = np.random.default_rng(seed)
    size = rng.choice([0.3, 1.0, 5.0])
    corners = rng.uniform(0.5, EDGE - 0.5, (2, 1, 3)) + rng.uniform(-size, size, (2, 3, 3))
    found = voxelize_surface(corners, EDGE)
    expected = [any(clipped(t, np.array(v)) for t in corners) for v in np.ndindex(found.shape)]
    assert found.ravel().tolist() == expected


def test_an_oblique_plane_has_the_voxels_whose_corners_it_parts():
    # x + y + z = 7.5 through a grid of five: no lattice point lies on it.
    reach = 60.0
    triangle = np.array([[[7.5 + reach, -reach / 2, -reach / 2], [-reach / 2, 7.5 + reach,
        -reach / 2], [-reach / 2, -reach / 2, 7.5 + reach]]])  # fmt: skip
    least = np.indices((5, 5, 5)).sum(axis=0)
    assert (voxelize_surface(triangle, 5) == ((least < 7.5) & (least + 3 > 7.5))).all()


def test_small_bites_change_nothing(monkeypatch):
    vertices, faces = box_arrays((0.3, 1.2, 0.4), (4.6, 3.7, 5.5))
    whole = voxelize_surface(vertices[faces], EDGE)
    monkeypatch.setattr(room, "_PAIRS", 7)
    assert (voxelize_surface(vertices[faces], EDGE) == whole).all()
    hollow = np.zeros_like(whole)
    hollow[0:5, 1:4, 0:6] = True
    hollow[1:4, 2:3, 1:5] = False
    assert (whole == hollow).all()


def test_what_lies_outside_the_grid_is_left_out():
    vertices, faces = box_arrays((-5, -5, -5), (-1, -1, -1))
    assert not voxelize_surface(vertices[faces], EDGE).any()
    vertices, faces = box_arrays((-5, -5, -5), (1.5, 9, 9))
    found = voxelize_surface(vertices[faces], EDGE)
    assert found[1].all() and found.sum() == EDGE**2


@pytest.mark.parametrize("count", [0, 1])
def test_nothing_and_a_point(count):
    found = voxelize_surface(np.full((count, 3, 3), 2.5), EDGE)
    assert found.sum() == count
