"""A part on a grid: where its void is, how deep its material, and where air comes from outside.

One grid over the whole part, its layers as the printer sees them: z up from the plate.  What lies
below the plate is closed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.mesh.winding_columns import crossings_of
from printprep.types import Grid

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

# Cells along a hole's diameter, and the most along the part's longest side.
CELLS_PER_DIAMETER = 5.0
MOST_CELLS = 200
# Cells of air around the part, for holes to end in.
MARGIN_CELLS = 8


@dataclass(frozen=True, eq=False)
class Dexels:
    """The stretches of a solid along the upright lines through a grid's columns.

    column : (n,) index i · ny + j of the column;  low_mm, high_mm : (n,) ends.
    Sorted by column, then upward.
    """

    column: Int
    low_mm: Float
    high_mm: Float


@dataclass(frozen=True, eq=False)
class Space:
    """A part's material, void and surroundings on one grid; arrays of shape ``grid.shape``.

    void : bool, cells of the cavities.
    depth_mm : float32, below the part's outside, to about half a cell, negative in the air.
    open : bool, cells of the air with a way to the air around the part through layers no higher.
    """

    grid: Grid
    void: Bool
    depth_mm: Float
    open: Bool

    def index(self, points: Float) -> tuple[Int, ...]:
        """Cells that points (n, 3) lie in, clipped to the grid, as an index."""
        cell = np.rint((points - self.grid.origin_mm) / self.grid.pitch_mm).astype(np.int64)
        return tuple(np.clip(cell, 0, np.array(self.grid.shape) - 1).T)

    def depth_at(self, points: Float) -> Float:
        """(n,) interpolated depth at points (n, 3)."""
        from scipy.ndimage import map_coordinates

        where = ((points - self.grid.origin_mm) / self.grid.pitch_mm).T
        result: Float = map_coordinates(self.depth_mm, where, order=1, mode="nearest")
        return result


def around(outside: Manifold, diameter_mm: float) -> Space:
    """A part without cavities on a grid fine enough for holes of a diameter."""
    from scipy.ndimage import distance_transform_edt

    box = np.array(outside.bounding_box())
    longest = float((box[3:] - box[:3]).max())
    pitch = max(diameter_mm / CELLS_PER_DIAMETER, longest / MOST_CELLS)
    # The plate, z = 0, lies on the lowest cells' lower faces
    low = np.array([*(box[:2] - MARGIN_CELLS * pitch), pitch / 2])
    counts = np.ceil((box[3:] + MARGIN_CELLS * pitch - low) / pitch).astype(int) + 1
    grid = Grid(low, pitch, (int(counts[0]), int(counts[1]), int(counts[2])))
    body = filled(dexels_of(outside, grid), grid)
    deep = distance_transform_edt(body) - distance_transform_edt(~body)
    depth = ((deep - 0.5 * np.sign(deep)) * pitch).astype(np.float32)
    return Space(grid, np.zeros_like(body), depth, open_air(~body))


def hollowed(space: Space, void: Manifold) -> Space:
    """The same part with cavities, which lie inside it."""
    return replace(space, void=filled(dexels_of(void, space.grid), space.grid))


def dexels_of(manifold: Manifold, grid: Grid) -> Dexels:
    """A solid along the lines through a grid's columns, a hair beside their centres."""
    nx, ny, _ = grid.shape
    x, y = (grid.origin_mm[axis] + grid.pitch_mm * np.arange(grid.shape[axis]) for axis in (0, 1))
    lines = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(nx * ny, 2)
    lines += np.random.default_rng(0).uniform(-1e-4, 1e-4, lines.shape) * grid.pitch_mm
    found = crossings_of(*arrays(manifold), lines)
    return Dexels(found.column[::2], found.z_mm[::2], found.z_mm[1::2])


def open_air(empty: Bool) -> Bool:
    """Cells of the air that a way through air in layers no higher joins to the grid's sides.

    The plate is closed.  What is not open at its layer is a cup while the part is printed.
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


def filled(dexels: Dexels, grid: Grid) -> Bool:
    """Cells whose centre lies in a dexel."""
    nx, ny, nz = grid.shape
    ends = np.zeros((nx * ny, nz + 1), dtype=np.int32)
    for z_mm, step in ((dexels.low_mm, 1), (dexels.high_mm, -1)):
        first = np.ceil((z_mm - grid.origin_mm[2]) / grid.pitch_mm).astype(int)
        np.add.at(ends, (dexels.column, np.clip(first, 0, nz)), step)
    return (np.cumsum(ends, axis=1)[:, :nz] > 0).reshape(grid.shape)
