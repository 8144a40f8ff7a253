"""The distance from any place in the hollowable volume down to where a column may stand.

Notation: a footing is a disc of radius R with no point in the hollowable volume; a column that ends
there stands on the shell with its whole rim.  Cells are a by a wide and a / tan θ high, so that a
step down by k cells may go k cells sideways.  L is the least length over ways of steps to a
footing.

L follows from the floor upward: L of a cell is the least, over steps down by one, two and three
layers, of the step's length plus the L where it ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.column_feet import ring

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

CELL_MM = 1.0
_LAYERS = 3
# A hexagon stands for the disc: feet are searched exactly later.
_CORNERS = 6


@dataclass(frozen=True, eq=False)
class DistanceToFooting:
    """L of every cell.

    low_mm : (3,) mm, middle of cell (0, 0, 0);  cell_mm : (3,) mm;  length_mm : (nx, ny, nz) mm, L.
    """

    low_mm: Float
    cell_mm: Float
    length_mm: Float

    @staticmethod
    def of(lookup: InsideLookup, members: MemberSizes, top_mm: float) -> DistanceToFooting:
        """Measure the way down from every place below ``top_mm``."""
        cell = np.array([CELL_MM, CELL_MM, CELL_MM / members.lean_tan])
        low = np.append(lookup.low_mm, lookup.floor_mm) - cell
        x, y = (
            np.arange(
                low[k], lookup.low_mm[k] + lookup.shape[k] * lookup.step_mm + cell[k], cell[k]
            )
            for k in range(2)
        )
        z = np.arange(low[2], top_mm + cell[2], cell[2])
        radius = members.leaning_radius_mm + lookup.step_mm / 2
        rim = radius * np.concatenate([np.zeros((1, 3)), ring(_CORNERS)])
        flat = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        at = lookup.at_heights(z)
        held = np.zeros((len(x), len(y), len(z)), dtype=bool)
        for offset in rim[:, :2]:
            held |= at[lookup.nearest(flat + offset)]
        return DistanceToFooting(low, cell, _lengths(held, cell))

    def way_mm(self, points: Float) -> Float:
        """(n,) mm, lengths of the ways down from points (n, 3) mm, by the nearest cell."""
        index = np.rint((points - self.low_mm) / self.cell_mm).astype(np.int64)
        index = np.minimum(np.maximum(index, 0), np.array(self.length_mm.shape) - 1)
        result: Float = self.length_mm[index[:, 0], index[:, 1], index[:, 2]]
        return result


def _lengths(held: Bool, cell: Float) -> Float:
    """(nx, ny, nz) mm, L, layer upon layer.

    held : (nx, ny, nz), cells that are not a footing;  cell : (3,) mm.
    """
    # No step leads beyond the cells, on any side.
    length = np.full([n + 2 * _LAYERS for n in held.shape[2:] + held.shape[:2]], np.inf)
    inner = length[(slice(_LAYERS, -_LAYERS),) * 3]
    inner[...] = 0.0
    moves, step = _steps(cell)
    offset = moves @ np.array([length[0].size, length.shape[2], 1])
    every = length.reshape(-1)
    for k in np.flatnonzero(held.any(axis=(0, 1))).tolist():
        i, j = np.nonzero(held[:, :, k])
        at = np.ravel_multi_index((k + _LAYERS, i + _LAYERS, j + _LAYERS), length.shape)
        every[at] = (every[at[:, None] + offset] + step).min(axis=1)
    return np.moveaxis(inner, 0, 2)


def _steps(cell: Float) -> tuple[Int, Float]:
    """(s, 3) steps in cells (layers down, along x, along y), and (s,) mm, their lengths.

    Over several layers only the widest steps count: shorter steps make up the others.
    cell : (3,) mm.
    """
    moves = [
        (-layers, i, j)
        for layers in range(1, _LAYERS + 1)
        for i in range(-layers, layers + 1)
        for j in range(-layers, layers + 1)
        if i * i + j * j <= layers * layers and (layers == 1 or max(abs(i), abs(j)) >= layers - 1)
    ]
    lengths = [math.hypot(k * cell[2], i * cell[0], j * cell[1]) for k, i, j in moves]
    return np.array(moves), np.array(lengths)
