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

from printprep.cavity.vaults.feet import ring

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.cavity.vaults.dexels import Dexels
    from printprep.cavity.vaults.members import Members
    from printprep.types import Float

    Float32 = NDArray[np.float32]

CELL_MM = 1.0
_LAYERS = 3
# Of the hexagon that stands for a disc: feet are looked for exactly later.
_CORNERS = 6


@dataclass(frozen=True, eq=False)
class Landings:
    """low_mm : (3,) middle of cell (0, 0, 0);  cell_mm : (3,);  length_mm : (nx, ny, nz), L;
    target_mm : (nx, ny, nz, 3) float32, middle of the cell where that way lands."""

    low_mm: Float
    cell_mm: Float
    length_mm: Float
    target_mm: Float32

    @staticmethod
    def of(dexels: Dexels, members: Members, top_mm: float) -> Landings:
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
        length = np.zeros((len(x), len(y), len(z)))
        target = np.zeros((*length.shape, 3), dtype=np.float32)
        for k, height in enumerate(z.tolist()):
            middles = np.concatenate([flat, np.full((*flat.shape[:2], 1), height)], axis=-1)
            target[:, :, k] = middles
            held = np.zeros(flat.shape[:2], dtype=bool)
            for offset in rim:
                held |= dexels.contains(middles + offset)
            if held.any():
                _step_down(length, target, k, held, cell)
        return Landings(low, cell, length, target)

    def way(self, points: Float) -> tuple[Float, Float]:
        """(n,) lengths and (n, 3) landings below points (n, 3), by the nearest cell."""
        index = np.rint((points - self.low_mm) / self.cell_mm).astype(np.int64)
        index = np.clip(index, 0, np.array(self.length_mm.shape) - 1)
        at = tuple(index.T)
        return self.length_mm[at], self.target_mm[at].astype(np.float64)


def _step_down(length: Float, target: Float32, k: int, held: Float, cell: Float) -> None:
    """Fill layer k where columns are ``held`` up, from the layers below; in place."""
    nx, ny = held.shape
    best = np.full(held.shape, np.inf)
    land = target[:, :, k].copy()
    for layers in range(1, min(_LAYERS, k) + 1):
        reach = layers
        for i in range(-reach, reach + 1):
            for j in range(-reach, reach + 1):
                if i * i + j * j > reach * reach or (
                    layers > 1 and max(abs(i), abs(j)) < layers - 1
                ):
                    continue
                fall = layers * float(cell[2])
                step = math.hypot(fall, i * float(cell[0]), j * float(cell[1]))
                to = (slice(max(0, -i), nx - max(0, i)), slice(max(0, -j), ny - max(0, j)))
                of = (slice(max(0, i), nx - max(0, -i)), slice(max(0, j), ny - max(0, -j)))
                total = length[:, :, k - layers][of] + step
                better = total < best[to]
                best[to] = np.where(better, total, best[to])
                land[to] = np.where(better[..., None], target[:, :, k - layers][of], land[to])
    length[:, :, k] = np.where(held, best, 0.0)
    target[:, :, k] = np.where(held[..., None], land, target[:, :, k])
