"""What is filled of a cavity because nothing drains it, as a solid with sloping tops."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.surface import isosurface
from printprep.types import Grid
from printprep.voxel.distance import DepthField
from printprep.voxel.grid import block_around, cropped

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.drains.pools import Pools
    from printprep.types import Bool, Float

# Liquid that stands lower than this is a film.
LEAST_MM = 0.01
# Cells that a filling reaches beyond its own, into the wall around and over a pool's lip.
INTO_WALL = 2.5
OVER_LIP = 0.75


def filling(pools: Pools, levels_mm: Float, void: Bool) -> Manifold:
    """The solid that fills every dexel up to its level, where that lies above its floor.

    void : the cavity's cells.  The filling reaches into the walls around: subtract it.
    """
    from manifold3d import Manifold
    from scipy.ndimage import distance_transform_edt

    standing = pools.standing_mm(levels_mm)
    wet = np.flatnonzero(standing > LEAST_MM)
    if not len(wet):
        return Manifold()
    grid = pools.grid
    pitch = grid.pitch_mm
    level = np.minimum(levels_mm, pools.dexels.high_mm + INTO_WALL * pitch)
    cells, top = _cells(pools, wet, level)
    block = block_around(cells, int(INTO_WALL) + 2)
    cells, top, part = cells[block], top[block], cropped(grid, block)
    away, nearest = distance_transform_edt(~cells, return_indices=True)
    z = part.origin_mm[2] + pitch * np.arange(part.shape[2])
    height = top[tuple(nearest)] - z
    reach = np.where(void[block] & ~cells, OVER_LIP, INTO_WALL)
    field = np.minimum(height, (reach - away) * pitch)
    return isosurface(DepthField(part, np.clip(field, -2 * pitch, 2 * pitch).astype(np.float32)), 0)


def _cells(pools: Pools, wet: np.ndarray, level: Float) -> tuple[Bool, Float]:
    """Cells that a wet dexel passes through below its level, and that level."""
    grid: Grid = pools.grid
    nx, ny, nz = grid.shape
    cells = np.zeros((nx * ny, nz), dtype=bool)
    top = np.zeros((nx * ny, nz))
    bottom = grid.origin_mm[2] - grid.pitch_mm / 2
    reach = np.minimum(level[wet], pools.dexels.high_mm[wet])
    first = np.floor((pools.dexels.low_mm[wet] - bottom) / grid.pitch_mm).astype(int)
    last = np.floor((reach - bottom) / grid.pitch_mm).astype(int)
    times = last - first + 1
    dexel = np.repeat(np.arange(len(wet)), times)
    layer = np.arange(len(dexel)) - np.repeat(np.cumsum(times) - times, times) + first[dexel]
    layer = np.clip(layer, 0, nz - 1)
    column = pools.dexels.column[wet][dexel]
    cells[column, layer] = True
    top[column, layer] = level[wet][dexel]
    return cells.reshape(grid.shape), top.reshape(grid.shape)
