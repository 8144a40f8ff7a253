"""F-score and Chamfer distance on points and cubes whose distances are known."""

from __future__ import annotations

import numpy as np
import pytest
from evaluate_models import box_arrays

from printprep.evaluate.fidelity import aligned, compare, fidelity, sample_surface

CUBE = box_arrays((-0.5, -0.5, -0.5), (0.5, 0.5, 0.5))
BRICK = box_arrays((-0.5, -0.3, -0.1), (0.5, 0.3, 0.1))
# Two samples of density d on a plane are 1 / (2 √d) apart on average (Clark & Evans, 1954).
FLOOR = 0.5 * np.sqrt(6 / 10_000)


def test_equal_points_are_equal():
    points = sample_surface(*CUBE, 500, seed=3)
    same = compare(points, points)
    assert (same.f_score, same.chamfer) == (1.0, 0.0)


def test_a_cube_is_itself_but_for_the_sampling():
    found = fidelity(CUBE, CUBE)
    assert found.f_score == 1.0
    assert found.chamfer == pytest.approx(FLOOR, rel=0.1)


@pytest.mark.parametrize("apart, score", [(0.049, 1.0), (0.051, 0.0)])
def test_shifted_lattices_are_as_far_apart_as_they_are_shifted(apart, score):
    axis = np.arange(4) * 1.0
    lattice = np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)
    found = compare(lattice + np.array([apart, 0, 0]), lattice)
    assert found.chamfer == pytest.approx(apart)
    assert found.f_score == score


def test_the_score_is_the_harmonic_mean_of_precision_and_recall():
    found = compare(np.zeros((1, 3)), np.array([[0.0, 0, 0], [1.0, 0, 0]]))
    assert found.f_score == pytest.approx(2 * 1.0 * 0.5 / 1.5)
    assert found.chamfer == pytest.approx((0.0 + 0.5) / 2)


def test_alignment_undoes_a_small_motion():
    angle = np.radians(6)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    points = sample_surface(*BRICK, 4000, seed=1)
    moved = points @ turn.T + [0.02, -0.01, 0.015]
    assert compare(moved, points).chamfer > 0.02
    assert np.abs(aligned(moved, points) - points).max() < 0.005


def test_alignment_does_not_hide_a_change_of_size():
    vertices, faces = CUBE
    found = fidelity((1.2 * vertices, faces), CUBE)
    # Concentric cubes with faces 0.1 apart: nothing is nearer than that, and little farther.
    assert found.f_score < 0.05
    assert 0.1 < found.chamfer < 0.13


def test_samples_spread_by_area_and_repeat():
    points = sample_surface(*BRICK, 20_000, seed=0)
    assert (points == sample_surface(*BRICK, 20_000, seed=0)).all()
    areas = {2: 2 * 1.0 * 0.6, 1: 2 * 1.0 * 0.2, 0: 2 * 0.6 * 0.2}
    for axis, half in ((0, 0.5), (1, 0.3), (2, 0.1)):
        share = np.isclose(np.abs(points[:, axis]), half).mean()
        assert share == pytest.approx(areas[axis] / sum(areas.values()), abs=0.02)
