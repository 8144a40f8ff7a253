"""What stands and what falls, where nobody doubts it."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import voxel_box

from printprep.evaluate.drop import final_rotation_deg, scene_of_voxels
from printprep.paper.voxel_balance import tilt_deg

SHAPE = (16, 16, 16)


def test_a_cube_stays_where_it_is():
    cube = voxel_box(SHAPE, (4, 4, 2), (12, 12, 10)).astype(float)
    assert final_rotation_deg(cube, 2, seconds=2) < 0.01


def test_a_gallows_falls_on_its_side():
    post = voxel_box(SHAPE, (2, 7, 0), (4, 9, 16))
    gallows = (post | voxel_box(SHAPE, (4, 7, 13), (16, 9, 16))).astype(float)
    assert tilt_deg(gallows, 0) < 0
    # Its hull comes to rest on the line from the foot's edge (4, 0) to the arm's end (16, 13).
    lying = np.degrees(np.arctan2(13, 12))
    assert final_rotation_deg(gallows, 0, seconds=4) == pytest.approx(lying, abs=0.1)


def test_ballast_that_moves_the_centre_over_the_foot_keeps_it_up():
    outside = voxel_box(SHAPE, (2, 5, 0), (6, 11, 14))
    outside |= voxel_box(SHAPE, (6, 5, 10), (16, 11, 14))
    even = outside.astype(float)
    low = np.where(np.arange(16) < 4, 1.0, 0.05) * even
    assert tilt_deg(even, 0) < 0 < tilt_deg(low, 0)
    assert final_rotation_deg(even, 0, seconds=4) > 20 > final_rotation_deg(low, 0, seconds=4)


def test_the_scene_is_in_radii_of_gyration():
    cube = voxel_box(SHAPE, (4, 4, 2), (12, 12, 10)).astype(float)
    scene = scene_of_voxels(cube, 2)
    assert np.trace(scene.inertia) == pytest.approx(2.0)
    assert scene.points[:, 2].min() == pytest.approx(-scene.height)
    # A cube of half a metre: gyration √(3·(a²/12)) = a/2.
    assert scene.unit_mm == pytest.approx(250)
    assert scene.height == pytest.approx(1.0)
    assert len(scene.points) == 8
