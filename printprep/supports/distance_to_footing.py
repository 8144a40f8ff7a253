"""How far it is from anywhere in a room to a place where a column may stand.

Notation: a landing is a disc of radius R with no point in the room; a column that ends there stands
on the shell with its whole rim.  Cells are a by a wide and a / tan θ high, so that a step down by
k cells may go k cells sideways.  L is the least length over ways of steps to a landing.

L follows from the floor upward: that of a cell is the least, over steps of one, two and three
layers, of the step's length and the L where it ends.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.feet import ring

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int
    from printprep.supports.dexels import Dexels
    from printprep.supports.members import Members

CELL_MM = 1.0
_LAYERS = 3
# Of the hexagon that stands for a disc: feet are looked for exactly later.
_CORNERS = 6


@dataclass(frozen=True, eq=False)
class DistanceToFooting:
    """low_mm : (3,) middle of cell (0, 0, 0);  cell_mm : (3,);  length_mm : (nx, ny, nz), L."""

    low_mm: Float
    cell_mm: Float
    length_mm: Float

    @staticmethod
    def of(dexels: Dexels, members: Members, top_mm: float) -> DistanceToFooting:
        """Find the way down from everywhere below ``top_mm``."""
        cell = np.array([CELL_MM, CELL_MM, CELL_MM / members.lean_tan])
        low = np.append(dexels.low_mm, dexels.floor_mm) - cell
        x, y = (
            np.arange(
                low[k], dexels.low_mm[k] + dexels.shape[k] * dexels.step_mm + cell[k], cell[k]
            )
            for k in range(2)
        )
        z = np.arange(low[2], top_mm + cell[2], cell[2])
        radius = members.leaning_radius_mm + dexels.step_mm / 2
        rim = radius * np.concatenate([np.zeros((1, 3)), ring(_CORNERS)])
        flat = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
        at = dexels.at_heights(z)
        held = np.zeros((len(x), len(y), len(z)), dtype=bool)
        for offset in rim[:, :2]:
            held |= at[dexels.nearest(flat + offset)]
        return DistanceToFooting(low, cell, _lengths(held, cell))

    def way_mm(self, points: Float) -> Float:
        """(n,) lengths of the ways down from points (n, 3), by the nearest cell."""
        index = np.rint((points - self.low_mm) / self.cell_mm).astype(np.int64)
        index = np.minimum(np.maximum(index, 0), np.array(self.length_mm.shape) - 1)
        result: Float = self.length_mm[index[:, 0], index[:, 1], index[:, 2]]
        return result


def _lengths(held: Bool, cell: Float) -> Float:
    """(nx, ny, nz) L, from where columns are held up, of that shape, layer upon layer."""
    # Beyond the cells, on every side, none is to be stepped to.
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
    """(s, 3) steps down by layers, along x and along y, in cells, and (s,) their lengths.

    Of those over several layers only the widest: the others are made of shorter ones.
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
