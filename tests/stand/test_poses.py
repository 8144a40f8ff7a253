"""Poses in closed form: the faces of a box, the two flats of a leaning prism."""

from __future__ import annotations

import numpy as np
import pytest
import solids
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.mesh.measure import arrays
from printprep.stand.poses import in_pose, stable_poses
from printprep.stand.stability import stability


def test_a_box_stands_on_its_six_faces() -> None:
    poses = stable_poses(solids.box(10, 20, 40))
    angle = [np.degrees(np.arctan2(a, b)) for a, b in ((20, 10), (20, 10), (10, 20), (10, 20))]
    expected = sorted([*angle, *2 * [np.degrees(np.arctan2(10, 40))]], reverse=True)
    # On 20 × 40 the nearest edge is 10 away and the centre 5 up; on 10 × 40 5 and 10; on end 5, 20.
    assert [pose.tilt_deg for pose in poses] == pytest.approx(expected)


def test_turned_into_a_pose_it_stands_as_the_pose_says() -> None:
    prism = solids.leaning_prism(20, 60, 50)
    for pose in stable_poses(prism):
        turned, move = in_pose(prism, pose)
        assert np.linalg.det(move[:3, :3]) == pytest.approx(1.0)
        assert turned.bounding_box()[2] == pytest.approx(0.0, abs=1e-9)
        assert stability(turned, 1e-3).tilt_deg == pytest.approx(pose.tilt_deg, abs=0.05)


def test_a_prism_that_leans_too_far_stands_on_its_sides_only() -> None:
    poses = stable_poses(solids.leaning_prism(20, 60, 50))
    downs = np.array([-pose.rotation[2] for pose in poses])
    assert np.all(np.abs(downs[:, 2]) < 0.9)


@given(st.floats(0, 360), st.floats(0, 360), st.floats(0, 360))
def test_poses_do_not_depend_on_how_it_came(x: float, y: float, z: float) -> None:
    box = solids.box(10, 20, 40)
    ours = [pose.tilt_deg for pose in stable_poses(box.rotate((x, y, z)))]
    assert ours == pytest.approx([pose.tilt_deg for pose in stable_poses(box)], abs=0.05)


def test_poses_are_the_same_for_any_order_of_the_hull_s_triangles(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    # The kernel sorts large hulls on several threads: two runs in forty gave another order
    from printprep.stand import poses

    rng = np.random.default_rng(0)
    solid = Manifold.hull_points(rng.normal(size=(300, 3)) * [30, 20, 10])
    expected = stable_poses(solid)
    vertices, faces = arrays(solid.hull())

    def in_another_order(_: Manifold) -> tuple[np.ndarray, np.ndarray]:
        turned = np.array([np.roll(face, rng.integers(3)) for face in rng.permutation(faces)])
        return vertices, turned

    monkeypatch.setattr(poses, "arrays", in_another_order)
    for _ in range(20):
        found = stable_poses(solid)
        assert [pose.tilt_deg for pose in found] == [pose.tilt_deg for pose in expected]
        assert all(
            (one.rotation == other.rotation).all()
            for one, other in zip(found, expected, strict=True)
        )
