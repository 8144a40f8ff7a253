"""A solid as dexels: its vertical stretches along the lines through the columns of a grid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.mesh.winding_columns import crossings_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int
    from printprep.types import Grid


@dataclass(frozen=True, eq=False)
class Dexels:
    """The stretches of a solid along the vertical lines through a grid's columns.

    column : (n,) index i · ny + j of the column;  low_mm, high_mm : (n,) mm, ends.
    Sorted by column, then upward.
    """

    column: Int
    low_mm: Float
    high_mm: Float


def dexels_of(manifold: Manifold, grid: Grid) -> Dexels:
    """Cut a solid along the lines through a grid's columns, just beside their centres."""
    nx, ny, _ = grid.shape
    x, y = (grid.origin_mm[axis] + grid.pitch_mm * np.arange(grid.shape[axis]) for axis in (0, 1))
    lines = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(nx * ny, 2)
    lines += np.random.default_rng(0).uniform(-1e-4, 1e-4, lines.shape) * grid.pitch_mm
    found = crossings_of(*arrays(manifold), lines)
    return Dexels(found.column[::2], found.z_mm[::2], found.z_mm[1::2])


def filled(dexels: Dexels, grid: Grid) -> Bool:
    """(nx, ny, nz) bool, the cells whose centres lie in a dexel."""
    nx, ny, nz = grid.shape
    ends = np.zeros((nx * ny, nz + 1), dtype=np.int32)
    for z_mm, step in ((dexels.low_mm, 1), (dexels.high_mm, -1)):
        first = np.ceil((z_mm - grid.origin_mm[2]) / grid.pitch_mm).astype(int)
        np.add.at(ends, (dexels.column, np.clip(first, 0, nz)), step)
    return (np.cumsum(ends, axis=1)[:, :nz] > 0).reshape(grid.shape)
