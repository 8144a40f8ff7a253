"""A voxelized part: its void, the depth of its material, and the air that is open to the outside.

One grid covers the whole part, z up from the plate.  All below the plate is closed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.dexels import dexels_of, filled
from printprep.grid.cell_distance import cell_distance
from printprep.types import Grid

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

# Cells along a hole's diameter, and the most along the part's longest side.
CELLS_PER_DIAMETER = 5.0
MOST_CELLS = 200
# Cells of air around the part, where holes end.
MARGIN_CELLS = 8


@dataclass(frozen=True, eq=False)
class VoxelizedPart:
    """A part's material, void and surroundings on one grid; arrays of its shape (nx, ny, nz).

    void : bool, cells of the cavities.
    depth_mm : float32, below the part's outside, to about half a cell, negative in the air.
    open : bool, cells of the air with a way to the air around the part through layers no higher.
    """

    grid: Grid
    void: Bool
    depth_mm: Float
    open: Bool

    def index(self, points: Float) -> tuple[Int, ...]:
        """Index of the cells that points (n, 3) mm lie in, clipped to the grid; three of (n,)."""
        cell = np.rint((points - self.grid.origin_mm) / self.grid.pitch_mm).astype(np.int64)
        return tuple(np.clip(cell, 0, np.array(self.grid.shape) - 1).T)

    def depth_at(self, points: Float) -> Float:
        """(n,) mm, interpolated depth at points (n, 3) mm."""
        from scipy.ndimage import map_coordinates

        where = ((points - self.grid.origin_mm) / self.grid.pitch_mm).T
        result: Float = map_coordinates(self.depth_mm, where, order=1, mode="nearest")
        return result


def voxelize(outside: Manifold, diameter_mm: float) -> VoxelizedPart:
    """Voxelize a part without cavities, fine enough for holes of a diameter."""
    box = np.array(outside.bounding_box())
    longest = float((box[3:] - box[:3]).max())
    pitch = max(diameter_mm / CELLS_PER_DIAMETER, longest / MOST_CELLS)
    # The plate, z = 0, lies on the lowest cells' lower faces
    low = np.array([*(box[:2] - MARGIN_CELLS * pitch), pitch / 2])
    counts = np.ceil((box[3:] + MARGIN_CELLS * pitch - low) / pitch).astype(int) + 1
    grid = Grid(low, pitch, (int(counts[0]), int(counts[1]), int(counts[2])))
    body = filled(dexels_of(outside, grid), grid)
    deep = cell_distance(body) - cell_distance(~body)
    depth = ((deep - 0.5 * np.sign(deep)) * pitch).astype(np.float32)
    return VoxelizedPart(grid, np.zeros_like(body), depth, open_air(~body))


def with_cavities(voxelized: VoxelizedPart, void: Manifold) -> VoxelizedPart:
    """The same part with cavities inside it.

    void : the cavities, as a positive solid.
    """
    return replace(voxelized, void=filled(dexels_of(void, voxelized.grid), voxelized.grid))


def open_air(empty: Bool) -> Bool:
    """Cells of the air with a way to the grid's sides through air in layers no higher.

    The plate is closed.  Air that is not open at its layer is a cup while the part prints.
    empty : (nx, ny, nz) bool;  returns the same shape.
    """
    from scipy.ndimage import label

    result = np.zeros_like(empty)
    rim = np.zeros(empty.shape[:2], dtype=bool)
    rim[[0, -1], :] = rim[:, [0, -1]] = True
    below = np.zeros(empty.shape[:2], dtype=bool)
    for layer in range(empty.shape[2]):
        piece, count = label(empty[:, :, layer])
        reached = np.zeros(count + 1, dtype=bool)
        reached[piece[(rim | below) & (piece > 0)]] = True
        below = reached[piece]
        result[:, :, layer] = below
    return result
