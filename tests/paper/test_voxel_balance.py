"""Voxel boxes have moments, inertia and tilt angles that can be written down."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import voxel_box
from hypothesis import given
from hypothesis import strategies as st

from printprep.paper.voxel_balance import footing, inertia, moments, support_polygon, tilt_deg

SIDES = st.tuples(*[st.integers(1, 9)] * 3)
CORNER = st.tuples(*[st.integers(0, 5)] * 3)


@given(SIDES, CORNER)
def test_a_box_of_voxels_is_a_box(sides, corner):
    high = tuple(c + s for c, s in zip(corner, sides, strict=True))
    weight = voxel_box((14, 15, 16), corner, high).astype(float)
    a, b, h = sides
    mass = a * b * h
    s = moments(weight, corner[2])
    middle = np.array([corner[0] + a / 2 - 7.0, corner[1] + b / 2 - 7.5, h / 2])
    assert s == pytest.approx([mass, *(mass * middle)])
    expected = np.diag([b * b + h * h, a * a + h * h, a * a + b * b]) * mass / 12
    assert inertia(weight, corner[2]) == pytest.approx(expected, abs=1e-9)
    assert tilt_deg(weight, corner[2]) == pytest.approx(np.degrees(np.arctan(min(a, b) / h)))


def test_density_counts():
    weight = voxel_box((6, 6, 6), (1, 1, 1), (5, 5, 5)).astype(float)
    weight[:, :, 3:] *= 0.5  # two layers full, two half
    mass, _, _, high = moments(weight, 1)
    assert mass == 16 * 3
    assert high / mass == pytest.approx((2 * 1.0 + 1 * 3.0) / 3)


def test_what_hangs_over_its_foot_has_a_negative_angle():
    weight = voxel_box((12, 8, 10), (1, 2, 0), (3, 6, 8))
    weight |= voxel_box((12, 8, 10), (3, 2, 6), (11, 6, 8))
    # Foot from x = 1 to 3; mass 2·4·8 at 2 and 8·4·2 at 7, and heights 4 and 7.
    assert tilt_deg(weight.astype(float), 0) == pytest.approx(
        np.degrees(np.arctan((3 - 4.5) / 5.5))
    )


def test_the_polygon_is_the_hull_of_squares():
    layer = np.zeros((5, 5), dtype=bool)
    layer[1, 1] = layer[3, 1] = layer[1, 3] = True
    polygon = support_polygon(layer)
    x, y = polygon.T
    area = (x * np.roll(y, -1) - y * np.roll(x, -1)).sum() / 2
    assert area == pytest.approx(3 * 3 - 2 * 2 / 2)  # positive: counter-clockwise
    foot = footing(layer)
    assert np.linalg.norm(foot.normals, axis=1) == pytest.approx(np.ones(len(foot.normals)))
    assert (foot.normals @ polygon.mean(axis=0) < foot.offsets_mm).all()
