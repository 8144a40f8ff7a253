"""Cracks between faces that do not share their corners are sewn, real holes are not."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

from printprep.mesh.repair import repair
from printprep.mesh.sew import sewn
from printprep.mesh.weld import unmatched_edges, weld
from printprep.mesh.winding_columns import winding_at
from printprep.types import Model

BALL = trimesh.creation.icosphere(subdivisions=3, radius=20.0)
BALL.apply_translation((0.0, 0.0, 20.0))
ROD = trimesh.creation.cylinder(radius=20.0, height=40.0, sections=400)


def model(vertices: NDArray[np.float64], faces: NDArray[np.int64]) -> Model:
    return Model(*weld(vertices, faces), np.eye(4), "model")


def apart(mesh: trimesh.Trimesh, crack_mm: float) -> Model:
    """Every triangle by itself, its corners up to half a crack from where they belong."""
    rng = np.random.default_rng(0)
    corners = np.asarray(mesh.triangles)
    corners = corners + crack_mm / 2 * rng.uniform(-1, 1, corners.shape) / np.sqrt(3)
    return model(corners.reshape(-1, 3), np.arange(corners.size // 3).reshape(-1, 3))


@pytest.mark.parametrize("crack_mm", [0.0005, 0.004, 0.03])
@pytest.mark.parametrize("mesh", [BALL, ROD], ids=["ball", "long thin triangles"])
def test_triangles_apart_become_the_surface_again(mesh: trimesh.Trimesh, crack_mm: float):
    seams = sewn(apart(mesh, crack_mm))
    assert len(unmatched_edges(seams.model.faces)) == 0
    assert len(seams.model.faces) == len(mesh.faces)
    assert 0 < seams.moved_mm <= crack_mm
    (action,) = seams.actions
    assert f"along {3 * len(mesh.faces)} open edges" in action


def test_the_solid_of_a_cracked_mesh_is_that_of_the_whole_one():
    solid = repair(apart(BALL, 0.004))
    assert float(solid.manifold.volume()) == pytest.approx(BALL.volume, rel=2e-4)
    assert solid.manifold.num_tri() == len(BALL.faces)
    assert solid.repair.rung == "union"
    assert 0 < solid.repair.moved_max_mm <= 0.008  # by sewing, and by samples beside it


def test_more_pieces_than_are_repaired_are_sewn():
    fine = trimesh.creation.icosphere(subdivisions=5, radius=20.0)  # 20,480 triangles
    assert repair(apart(fine, 0.004)).manifold.num_tri() == len(fine.faces)


def test_a_hole_stays_a_hole():
    given = model(np.asarray(BALL.vertices), np.asarray(BALL.faces)[5:])
    seams = sewn(given)
    assert seams.model is given
    assert (seams.moved_mm, seams.actions) == (0.0, ())


def test_the_ends_of_a_fine_rim_are_no_crack():
    """A rim of edges shorter than a crack would shrink to a point: that moves too far."""
    tube = trimesh.creation.cylinder(radius=2.0, height=40.0, sections=2000)  # edges of 0.006 mm
    sides = np.abs(tube.face_normals[:, 2]) < 0.5
    given = model(np.asarray(tube.vertices), np.asarray(tube.faces)[sides])
    assert sewn(given).model is given


def test_a_small_model_is_not_sewn_out_of_shape():
    small = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    given = apart(small, 0.02)
    assert sewn(given).model is given


def test_a_closed_model_is_left_alone():
    given = model(np.asarray(BALL.vertices), np.asarray(BALL.faces))
    assert sewn(given).model is given


@pytest.mark.parametrize("dropped", [1, 40, 700, 1279])
def test_winding_numbers_of_open_surfaces_are_sums_of_solid_angles(dropped: int):
    """Closed by lids from the middle of each hole, or by none where hardly any edge is shared."""
    rng = np.random.default_rng(1)
    faces = np.asarray(BALL.faces)[np.sort(rng.permutation(len(BALL.faces))[dropped:])]
    points = rng.uniform((-25, -25, -5), (25, 25, 45), (400, 3))
    corners = np.asarray(BALL.vertices)[faces][None] - points[:, None, None]
    a, b, c = (corners[:, :, k] for k in range(3))
    la, lb, lc = (np.linalg.norm(side, axis=2) for side in (a, b, c))
    # van Oosterom and Strackee, "The solid angle of a plane triangle", 1983
    above = np.einsum("pfi,pfi->pf", a, np.cross(b, c))
    below = la * lb * lc + (a * b).sum(2) * lc + (b * c).sum(2) * la + (c * a).sum(2) * lb
    expected = 2 * np.arctan2(above, below).sum(axis=1) / (4 * np.pi)
    found = winding_at(points, np.asarray(BALL.vertices), faces)
    np.testing.assert_allclose(found, expected, atol=5e-3)
