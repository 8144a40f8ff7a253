"""Up, size and seat, and the matrix that says what was done."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from mesh_bodies import box

from printprep.errors import UsageError
from printprep.mesh.measure import signed_volumes
from printprep.mesh.place import place, rotation
from printprep.mesh.read import RawMesh

UPS = ["+x", "-x", "+y", "-y", "+z", "-z"]


def raw(vertices: np.ndarray, faces: np.ndarray) -> RawMesh:
    return RawMesh(vertices, faces, "box", np.eye(4))


@pytest.mark.parametrize("up", UPS)
def test_the_named_axis_points_up_and_nothing_is_mirrored(up: str) -> None:
    turn = rotation(up)
    axis = np.zeros(3)
    axis["xyz".index(up[1])] = 1 if up[0] == "+" else -1
    assert (turn @ axis).tolist() == [0, 0, 1]
    assert np.linalg.det(turn) == pytest.approx(1)


@pytest.mark.parametrize(("given_up", "same"), [("x", "+x"), ("Y", "+y"), (" z ", "+z")])
def test_the_sign_may_be_left_out(given_up: str, same: str) -> None:
    assert (rotation(given_up) == rotation(same)).all()


@given(
    st.sampled_from(UPS),
    st.integers(0, 2**31),
    st.sampled_from([{}, {"scale": 2.5}, {"height_mm": 40.0}, {"size_mm": 100.0}]),
)
def test_seated_sized_and_recorded(up: str, seed: int, size: dict[str, float]) -> None:
    rng = np.random.default_rng(seed)
    q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    vertices, faces = box((0, 0, 0), (1, 2, 3))
    vertices = vertices @ (q * np.sign(np.linalg.det(q))).T + rng.uniform(-20, 20, 3)
    model = place(raw(vertices, faces), up=up, **size)
    low, high = model.vertices.min(axis=0), model.vertices.max(axis=0)
    assert low[2] == 0
    assert low[:2] + high[:2] == pytest.approx([0, 0], abs=1e-9)
    if "height_mm" in size:
        assert high[2] == pytest.approx(40)
    if "size_mm" in size:
        assert (high - low).max() == pytest.approx(100)
    homogeneous = np.column_stack([vertices, np.ones(8)])
    assert (homogeneous @ model.placement.T)[:, :3] == pytest.approx(model.vertices, abs=1e-9)
    assert signed_volumes(model.vertices[faces]).sum() > 0


@pytest.mark.parametrize(
    "options",
    [
        {"up": "w"},
        {"up": "+"},
        {"up": ""},
        {"scale": 0.0},
        {"scale": float("nan")},
        {"height_mm": -1.0},
        {"size_mm": float("inf")},
        {"size_mm": 10.0, "height_mm": 10.0},
        {"size_mm": 10.0, "scale": 2.0},
    ],
)
def test_what_cannot_be_meant(options: dict[str, Any]) -> None:
    with pytest.raises(UsageError):
        place(raw(*box((0, 0, 0), (1, 1, 1))), **options)


def test_a_flat_model_has_no_height() -> None:
    vertices, faces = box((0, 0, 0), (1, 1, 0))
    with pytest.raises(UsageError, match="flat"):
        place(raw(vertices, faces), height_mm=10)
