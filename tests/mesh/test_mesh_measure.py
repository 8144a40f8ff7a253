"""Integrals and distances against closed forms, wherever the body lies."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_bodies import box, inside_out, joined, sphere

from printprep.errors import GeometryError
from printprep.mesh.measure import (
    arrays,
    bodies,
    distance_mm,
    from_arrays,
    mass_properties,
    shells,
    volume_and_centre,
    winding,
)


@pytest.mark.parametrize("far", [0.0, 1e4])
def test_box_is_exact(far: float) -> None:
    x, y, z = 3.0, 5.0, 7.0
    found = mass_properties(from_arrays(*box((far, far, far), (far + x, far + y, far + z))))
    volume = x * y * z
    assert found.volume_mm3 == pytest.approx(volume, rel=1e-12)
    assert found.centre_mm == pytest.approx((far + x / 2, far + y / 2, far + z / 2), rel=1e-14)
    wanted = volume / 12 * np.diag([y * y + z * z, x * x + z * z, x * x + y * y])
    assert np.array(found.inertia_mm5) == pytest.approx(wanted, rel=1e-11, abs=1e-8)


def test_ball_is_bounded_on_both_sides() -> None:
    """The icosphere lies inside the ball and holds the ball of its facets' inradius."""
    vertices, faces = sphere(10.0)
    inner = np.linalg.norm(vertices[faces].mean(axis=1), axis=1).min()
    found = mass_properties(from_arrays(vertices, faces))
    assert 4 / 3 * np.pi * inner**3 < found.volume_mm3 < 4 / 3 * np.pi * 1000
    assert found.centre_mm == pytest.approx((0, 0, 0), abs=1e-12)
    moment = 8 / 15 * np.pi
    assert moment * inner**5 < found.inertia_mm5[0][0] < moment * 10.0**5


def test_a_void_subtracts_itself() -> None:
    part = from_arrays(*joined(box((0, 0, 0), (10, 10, 10)), inside_out(box((1, 1, 1), (3, 3, 3)))))
    found = mass_properties(part)
    assert found.volume_mm3 == pytest.approx(1000 - 8)
    assert found.centre_mm[0] == pytest.approx((1000 * 5 - 8 * 2) / 992)
    solids, voids = shells(part)
    assert [shell.volume() for shell in solids] == [pytest.approx(1000)]
    assert [shell.volume() for shell in voids] == [pytest.approx(8)]


def test_volume_and_centre_are_those_of_the_mass_properties() -> None:
    part = from_arrays(*joined(sphere(7.0), inside_out(box((1, 1, 1), (3, 3, 3)))))
    whole = mass_properties(part)
    assert volume_and_centre(part) == (whole.volume_mm3, whole.centre_mm)
    with pytest.raises(GeometryError, match="empty solid"):
        volume_and_centre(part - part)


def test_one_body_with_voids_is_the_solid_itself() -> None:
    part = from_arrays(*joined(box((0, 0, 0), (10, 10, 10)), inside_out(box((1, 1, 1), (3, 3, 3)))))
    (body,) = bodies(part)
    assert body is part


def test_bodies_keep_their_own_voids() -> None:
    part = from_arrays(
        *joined(
            box((0, 0, 0), (10, 10, 10)),
            inside_out(box((1, 1, 1), (9, 9, 9))),
            box((2, 2, 2), (8, 8, 8)),
            inside_out(box((3, 3, 3), (7, 7, 7))),
            box((20, 0, 0), (21, 1, 1)),
        )
    )
    volumes = sorted(body.volume() for body in bodies(part))
    assert volumes == pytest.approx([1, 216 - 64, 1000 - 512])


def test_distance_and_winding_of_a_box() -> None:
    part = from_arrays(*box((0, 0, 0), (2, 2, 2)))
    points = np.array([[1, 1, 1], [1, 1, 3], [3, 3, 1], [0.25, 1, 1]], dtype=np.float64)
    assert distance_mm(points, part) == pytest.approx([1, 1, np.sqrt(2), 0.25])
    assert winding(points, *arrays(part)) == pytest.approx([1, 0, 0, 1], abs=0.01)
    assert len(distance_mm(np.zeros((0, 3)), part)) == 0


def test_open_surface_and_emptiness_are_refused() -> None:
    vertices, faces = box((0, 0, 0), (1, 1, 1))
    with pytest.raises(GeometryError, match="open or doubled edges"):
        from_arrays(vertices, faces[:-1])
    with pytest.raises(GeometryError, match="no centre of mass"):
        mass_properties(
            from_arrays(*box((0, 0, 0), (1, 1, 1))) ^ from_arrays(*box((5,) * 3, (6,) * 3))
        )


@given(st.lists(st.floats(-50, 50), min_size=3, max_size=3), st.integers(0, 2**31))
def test_mass_properties_turn_with_the_body(shift: list[float], seed: int) -> None:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    turn = q * np.sign(np.linalg.det(q))
    vertices, faces = box((0, 0, 0), (1, 2, 3))
    still = mass_properties(from_arrays(vertices, faces))
    moved = mass_properties(from_arrays(vertices @ turn.T + shift, faces))
    assert moved.volume_mm3 == pytest.approx(6, rel=1e-12)
    centre = turn @ np.array(still.centre_mm) + shift
    assert moved.centre_mm == pytest.approx(tuple(centre), abs=1e-10)
    wanted = turn @ np.array(still.inertia_mm5) @ turn.T
    assert np.array(moved.inertia_mm5) == pytest.approx(wanted, abs=1e-9)
