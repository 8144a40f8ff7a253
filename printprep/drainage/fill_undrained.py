"""Fill the parts of a cavity that nothing drains, with a solid whose tops slope."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.surface import isosurface
from printprep.grid.distance import DepthField
from printprep.grid.grid import block_around, cropped

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.drainage.voxelized_part import VoxelizedPart

# Cells that a filling reaches beyond its own: into the wall around it, and over a pool's lip.
INTO_WALL = 2.5
OVER_LIP = 0.75


def filling(voxelized: VoxelizedPart, tops_mm: Float) -> Manifold:
    """The solid that fills a part's void up to a height in every column.

    tops_mm : (k,) mm, the height for every void cell, in C order; −inf where nothing is filled.
    The solid reaches into the walls around: subtract it from the void.
    """
    from manifold3d import Manifold
    from scipy.ndimage import distance_transform_edt

    grid = voxelized.grid
    pitch = grid.pitch_mm
    top = np.full(grid.shape, -np.inf)
    top[voxelized.void] = tops_mm
    z = grid.origin_mm[2] + pitch * np.arange(grid.shape[2])
    # A floor between two centres belongs to the upper cell
    cells = top > z - pitch
    if not cells.any():
        return Manifold()
    block = block_around(cells, int(INTO_WALL) + 2)
    cells, top, void = cells[block], top[block], voxelized.void[block]
    away, nearest = distance_transform_edt(~cells, return_indices=True)
    height = np.minimum(top[tuple(nearest)] - z[block[2]], 2 * pitch)
    # The distance to its cells ends the filling: so its sides stand upright in the wall
    field = np.minimum(height, (np.where(void & ~cells, OVER_LIP, INTO_WALL) - away) * pitch)
    field = np.maximum(field, -2 * pitch).astype(np.float32)
    return isosurface(DepthField(cropped(grid, block), field), 0.0)
