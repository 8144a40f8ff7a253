"""Meshes whose every figure is known, for the tests beside this file."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from printprep.types import Model

Float = NDArray[np.float64]
Int = NDArray[np.int64]

# The twelve triangles of a box over corners numbered by bits x, y, z.
_FACES = (
    (0, 2, 1), (1, 2, 3), (4, 5, 6), (5, 7, 6), (0, 1, 4), (1, 5, 4),
    (2, 6, 3), (3, 6, 7), (0, 4, 2), (2, 4, 6), (1, 3, 5), (3, 7, 5),
)  # fmt: skip


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> tuple[Float, Int]:
    """A box, counter-clockwise seen from outside."""
    bits = (np.arange(8)[:, None] >> np.arange(3)) & 1
    corners = np.where(bits == 1, np.array(high), np.array(low)).astype(np.float64)
    return corners, np.array(_FACES, dtype=np.int64)


def joined(*meshes: tuple[Float, Int]) -> tuple[Float, Int]:
    """Several meshes in one list, not welded."""
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in meshes)])[:-1]
    return (
        np.concatenate([vertices for vertices, _ in meshes]),
        np.concatenate([faces + start for (_, faces), start in zip(meshes, starts, strict=True)]),
    )


def inside_out(mesh: tuple[Float, Int]) -> tuple[Float, Int]:
    """The same surface, every triangle reversed."""
    return mesh[0], np.ascontiguousarray(mesh[1][:, ::-1])


def sphere(radius: float, subdivisions: int = 4) -> tuple[Float, Int]:
    """An icosphere about the origin."""
    import trimesh

    ball = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    return np.array(ball.vertices, dtype=np.float64), np.array(ball.faces, dtype=np.int64)


def model(mesh: tuple[Float, Int]) -> Model:
    """A mesh as the reader would hand it on, where it is."""
    return Model(*mesh, placement=np.eye(4), name="made")
