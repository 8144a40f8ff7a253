"""Boxes and the strict judge, for the tests of this folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import lib3mf
import numpy as np

if TYPE_CHECKING:
    from printprep.types import Float, Int

BOX_FACES: Int = np.array(
    [
        *([0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7], [0, 1, 5], [0, 5, 4]),
        *([1, 2, 6], [1, 6, 5], [2, 3, 7], [2, 7, 6], [3, 0, 4], [3, 4, 7]),
    ]
)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Float:
    """The eight corners that BOX_FACES joins, outside out."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    bottom = [(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)]
    return np.array(bottom + [(x, y, z1) for x, y, _ in bottom], dtype=np.float64)


def hollow_box(side: float, wall: float) -> tuple[Float, Int]:
    """A cube on the bed, with an inverted cubic shell inside it."""
    outer = box((0, 0, 0), (side, side, side))
    inner = box((wall, wall, wall), (side - wall, side - wall, side - wall))
    return np.vstack([outer, inner]), np.vstack([BOX_FACES, BOX_FACES[:, ::-1] + 8])


def volume(vertices: Float, faces: Int) -> float:
    """Signed volume in the unit of the vertices cubed (divergence theorem)."""
    a, b, c = (vertices[faces[:, index]] for index in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def judge_strictly(content: bytes, path: Path) -> lib3mf.Model:
    """Read with lib3mf in strict mode: any deviation is an exception or a warning, both fatal."""
    path.write_bytes(content)
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    warnings = [reader.GetWarning(index) for index in range(reader.GetWarningCount())]
    assert warnings == []
    return model
