"""Find where the centre of a ball fits in a void: the places that a hole of its width can drain.

Clearance is the distance to the void's surface.  It is exact where it decides, near the ball's
radius: a ball at rest is placed to a few hundredths of a millimetre between two cells of its
column.  Nothing is searched between columns: a neck hardly wider than the ball counts as closed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.dexels import Dexels
from printprep.grid.cell_distance import cell_distance
from printprep.grid.grid import block_around, points_mm

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.drainage.voxelized_part import VoxelizedPart
    from printprep.grid.distance import Surface

# Clearance on the grid alone is right to this many cells; nearer to the radius it is measured.
UNSURE_CELLS = 1.5


@dataclass(frozen=True, eq=False)
class Balls:
    """Where the centres of balls of one radius fit, as dexels over the grid's columns.

    volume_mm3 : (n,) mm³, void nearest to each dexel, which drains with it.
    nearest : (k,) for every void cell, in C order, the dexel nearest to it;  −1 for none.
    body : (n,) the connected part of the void that each dexel lies in.
    """

    radius_mm: float
    dexels: Dexels
    volume_mm3: Float
    nearest: Int
    body: Int


def balls_in(voxelized: VoxelizedPart, surface: Surface, radius_mm: float) -> Balls:
    """Find the balls of one radius that fit in a part's void.

    surface : of the void.
    """
    from scipy.ndimage import distance_transform_edt, generate_binary_structure, label

    grid, void = voxelized.grid, voxelized.void
    nothing = np.zeros(0, dtype=np.int64)
    if not void.any():
        dexels = Dexels(nothing, np.zeros(0), np.zeros(0))
        return Balls(radius_mm, dexels, np.zeros(0), nothing, nothing)
    block = block_around(void, 1)
    inside = void[block]
    clearance = (cell_distance(inside).astype(np.float64) - 0.5) * grid.pitch_mm
    unsure = inside & (np.abs(clearance - radius_mm) < UNSURE_CELLS * grid.pitch_mm)
    at = np.stack(np.nonzero(unsure), axis=1) + [axis.start for axis in block]
    index = np.ravel_multi_index(tuple(at.T), grid.shape)
    clearance[unsure] = surface.distance_mm(points_mm(grid, index))
    fits = inside & (clearance >= radius_mm)
    number, dexels = _runs(voxelized, block, clearance, fits, radius_mm)
    count = len(dexels.column)
    if not count:
        every = np.full(int(void.sum()), -1, dtype=np.int64)
        return Balls(radius_mm, dexels, np.zeros(0), every, nothing)
    where = distance_transform_edt(~fits, return_distances=False, return_indices=True)
    nearest = number[tuple(where)][inside].astype(np.int64)
    piece, _ = label(inside, structure=generate_binary_structure(3, 3))
    # A void that holds no ball belongs to no dexel
    body = np.zeros(count, dtype=np.int64)
    body[number[fits]] = piece[fits]
    nearest = np.where(body[nearest] == piece[inside], nearest, -1)
    cells = np.bincount(nearest[nearest >= 0], minlength=count)
    volume: Float = cells.astype(float) * grid.pitch_mm**3
    return Balls(radius_mm, dexels, volume, nearest, body)


def _runs(
    voxelized: VoxelizedPart,
    block: tuple[slice, slice, slice],
    clearance: Float,
    fits: np.ndarray,
    radius_mm: float,
) -> tuple[Int, Dexels]:
    """Number the runs of fitting cells in each column, and find their ends between cells.

    clearance : (a, b, c) mm, fits : (a, b, c) bool, both of the block.
    Returns (a, b, c) the run's number, valid where a cell fits, and the runs as dexels.
    """
    grid = voxelized.grid
    pitch = grid.pitch_mm
    before = np.zeros_like(fits)
    before[:, :, 1:] = fits[:, :, :-1]
    after = np.zeros_like(fits)
    after[:, :, :-1] = fits[:, :, 1:]
    starts, ends = fits & ~before, fits & ~after
    number = (np.cumsum(starts).reshape(fits.shape) - 1).astype(np.int64)
    i, j, low = np.nonzero(starts)
    _, _, high = np.nonzero(ends)

    def end(k: Int, way: int) -> Float:
        """(n,) mm, heights where runs end that reach to cells k (n,), upward or downward."""
        here, there = clearance[i, j, k], clearance[i, j, k + way]
        share = (here - radius_mm) / np.maximum(here - there, 1e-9)
        z = grid.origin_mm[2] + pitch * (k + block[2].start)
        result: Float = z + way * pitch * np.clip(share, 0.0, 1.0)
        return result

    column = (i + block[0].start) * grid.shape[1] + j + block[1].start
    return number, Dexels(column, end(low, -1), end(high, 1))
