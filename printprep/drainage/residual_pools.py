"""Fill residual pools: dents and tips of any size that the filling of larger pools leaves.

Balls find where a hole is needed and what a hole can drain.  Their fillings meet in steps, with
dents between them that no ball resolves.  So the remaining floor is flooded once more, as drops
run: on columns twice as fine, to the exact heights of the surface.  Drops run between columns that
share a side, as pixels of a layer do.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.surface import isosurface
from printprep.drainage.balls import Balls
from printprep.drainage.dexels import Dexels, dexels_of
from printprep.drainage.pools import LEAST_MM, SLOPE, Pools
from printprep.grid.cell_distance import cell_distance
from printprep.grid.distance import DepthField
from printprep.grid.grid import cropped
from printprep.types import Grid

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int
    from printprep.drainage.channel import Channel

# A shallower dent holds a film only.
FILM_MM = 0.03
# Nothing runs where the ceiling is no higher than this above the floor: such cracks remain where
# one filling ends below another.
CRACK_MM = 0.3
# Half of the slope of the floors: drops run by sides, up to √2 as far, and refill no floor.
FALL = SLOPE / 2
# Cells that a filling reaches beyond its own, into the wall around, and the grid's margin for it.
INTO_WALL = 2.5
MARGIN = 4
# Beside its own cells a filling lies this share of a cell below the floor: there it fills nothing.
UNDER_FLOOR = 0.25


def residual_pools(
    void: Manifold, channels: Sequence[Channel], pitch_mm: float, least_mm3: float = 0.0
) -> Manifold:
    """The solid that fills what does not run out of a void through outlets; it reaches into walls.

    channels : the outlets;  pitch_mm : of the columns on which drops run;  least_mm3 : a dent that
    holds less stays: a crumb in it would not print.
    """
    from manifold3d import Manifold, OpType

    if void.is_empty():
        return Manifold()
    grid = _grid_over(void, pitch_mm)
    dexels = dexels_of(void, grid)
    nothing = np.zeros(len(dexels.column))
    above_cracks = Dexels(dexels.column, dexels.low_mm, dexels.high_mm - CRACK_MM)
    unused = nothing.astype(np.int64)
    pools = Pools(Balls(0.0, above_cracks, nothing, unused, unused), grid, diagonal=False)
    levels = pools.levels(pools.outlets(channels), FALL)
    depth = levels - dexels.low_mm
    label = _dents(pools, Pools(Balls(0.0, dexels, nothing, unused, unused), grid), depth)
    wet = label >= 0
    held = np.bincount(label[wet], weights=depth[wet] * pitch_mm**2)
    deep = np.unique(label[depth > FILM_MM])
    deep = deep[held[deep] >= least_mm3]
    floor = Floor(grid, dexels, np.where(wet, levels, -np.inf))
    return Manifold.batch_boolean(
        [Manifold(), *(floor.filled(np.flatnonzero(label == dent)) for dent in deep)], OpType.Add
    )


def _dents(pools: Pools, whole: Pools, depth_mm: Float) -> Int:
    """(n,) the number of the dent that each wet dexel belongs to, else −1.

    pools : above cracks;  whole : with cracks;  depth_mm : (n,) mm, inf where nothing runs out.

    A crack is a sheet of many dexels, of which drops join no two: it is one dent by itself.
    """
    lost = np.isinf(depth_mm)
    label = pools.connected((depth_mm > LEAST_MM) & ~lost)
    sheet = whole.connected(lost)
    return np.where(lost, sheet + label.max(initial=-1) + 1, label)


class Floor:
    """The floor of a void as heights over columns, with levels to raise it to.

    level_mm : (n,) mm, for each dexel, −inf where its floor stays;  top_mm : (n,) mm, the same, but
        just below the floor where that stays.
    """

    def __init__(self, grid: Grid, dexels: Dexels, level_mm: Float) -> None:
        """level_mm : (n,) mm, for each dexel."""
        self.grid = grid
        self.dexels = dexels
        dry = dexels.low_mm - UNDER_FLOOR * grid.pitch_mm
        self.top_mm = np.where(np.isfinite(level_mm) | (level_mm > 0), level_mm, dry)
        self._dexel = np.full(grid.shape, -1, dtype=np.int32)
        cell, dexel = self._cells(np.arange(len(dexels.column)))
        self._dexel.reshape(-1)[cell] = dexel

    def filled(self, dent: Int) -> Manifold:
        """The solid that raises the floor of a dent (k,) of dexels, up to the floor around it."""
        from scipy.ndimage import distance_transform_edt

        at = np.column_stack(np.unravel_index(self._cells(dent)[0], self.grid.shape))
        # The grid has the same margin, so the block stays within it.
        start, stop = at.min(axis=0) - MARGIN, at.max(axis=0) + MARGIN + 1
        i, j, k = map(slice, start, stop)
        block = (i, j, k)
        grid, pitch = cropped(self.grid, block), self.grid.pitch_mm
        cells = np.zeros(grid.shape, dtype=bool)
        cells[tuple((at - start).T)] = True
        dexel = self._dexel[block]
        void: Bool = dexel >= 0
        nearest = distance_transform_edt(~void, return_distances=False, return_indices=True)
        top = self.top_mm[dexel[tuple(nearest)]]
        z = grid.origin_mm[2] + pitch * np.arange(grid.shape[2])
        field = np.clip(top - z, -2 * pitch, 2 * pitch)
        field = np.minimum(field, (INTO_WALL - cell_distance(~cells)) * pitch)
        return isosurface(DepthField(grid, field.astype(np.float32)), 0.0)

    def _cells(self, of: Int) -> tuple[Int, Int]:
        """Flat cells (m,) whose centres lie in dexels ``of`` (k,), and the dexel (m,) of each.

        Each dexel has at least one cell.
        """
        low, pitch = self.grid.origin_mm[2], self.grid.pitch_mm
        first = np.ceil((self.dexels.low_mm[of] - low) / pitch).astype(np.int64)
        last = np.floor((self.dexels.high_mm[of] - low) / pitch).astype(np.int64)
        count = np.maximum(last - first + 1, 1)
        step = np.arange(int(count.sum())) - np.repeat(np.cumsum(count) - count, count)
        cell = np.repeat(self.dexels.column[of] * self.grid.shape[2] + first, count) + step
        return cell, np.repeat(of, count)


def _grid_over(void: Manifold, pitch_mm: float) -> Grid:
    box = np.array(void.bounding_box())
    low = box[:3] - MARGIN * pitch_mm
    counts = np.ceil((box[3:] - box[:3]) / pitch_mm).astype(int) + 2 * MARGIN + 1
    return Grid(low, pitch_mm, (int(counts[0]), int(counts[1]), int(counts[2])))
