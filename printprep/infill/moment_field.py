"""Moments of the interior that infill fills, from measured depths: no surface is needed.

A cell of the fine depth field counts with its share that lies deeper than the level; the share is
linear in the depth of the cell's centre.  What a column loses from one cell to the next one above
is its ceiling.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.distance import DepthField, upsampled
from printprep.grid.domain import Interior, interior_of
from printprep.grid.grid import axis_mm, subdivided

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.grid.depth import Depths
    from printprep.types import Solid


@dataclass(frozen=True, eq=False)
class MomentField:
    """The interior deeper than a level, by cells of the optimization's grid.

    volume : (4, nx, ny, nz) volume in mm³ and its first moments x, y, z in mm⁴.
    ceiling : (4, nx, ny, nz) area in plan view in mm² of all that faces the interior from above,
    and its first moments x, y, z in mm³.
    """

    volume: Float
    ceiling: Float

    def interior(self, solid: Solid, depths: Depths) -> Interior:
        """The interior as the program's free voxels."""
        return interior_of(solid, depths, self.volume)


def moment_field_of(depths: Depths, level_mm: float) -> MomentField:
    """The moments of what lies deeper than a level; all zero if nothing is that deep."""
    grid = depths.grid
    moment_field = MomentField(np.zeros((4, *grid.shape)), np.zeros((4, *grid.shape)))
    field = depths.field
    if field is None:
        return moment_field
    wider = round(field.grid.pitch_mm / grid.pitch_mm)
    if wider > 1:
        finer = subdivided(field.grid, wider)
        field = DepthField(finer, upsampled(field.depth_mm, wider))
    fine = field.grid
    factor = round(grid.pitch_mm / fine.pitch_mm)
    middle = fine.origin_mm + (grid.pitch_mm - fine.pitch_mm) / 2
    first = np.rint((middle - grid.origin_mm) / grid.pitch_mm).astype(int)
    x, y, z = (axis_mm(fine, axis) for axis in range(3))
    # The field may reach a little beyond the grid, where nothing is deep
    nx, ny, nz = (
        min(count // factor, most - start)
        for count, most, start in zip(fine.shape, grid.shape, first.tolist(), strict=True)
    )
    y, z = y[: ny * factor], z[: nz * factor]
    block = np.s_[first[1] : first[1] + ny, first[2] : first[2] + nz]
    for i in range(nx):  # slab by slab, because the field is large
        slab = slice(i * factor, (i + 1) * factor)
        depth = field.depth_mm[slab, : ny * factor, : nz * factor].astype(float)
        deeper = (depth - level_mm) / fine.pitch_mm
        share = np.clip(deeper + 0.5, 0.0, 1.0)
        above = np.concatenate([share[:, :, 1:], np.zeros_like(share[:, :, :1])], axis=2)
        lost = np.maximum(share - above, 0.0)
        for out, weight, height in (
            (moment_field.volume, share * fine.pitch_mm**3, z),
            (moment_field.ceiling, lost * fine.pitch_mm**2, z + fine.pitch_mm / 2),
        ):
            cells = out[(slice(None), first[0] + i, *block)]
            cells[0] = _summed(weight, factor)
            cells[1] = _summed(weight * x[slab][:, None, None], factor)
            cells[2] = _summed(weight * y[:, None], factor)
            cells[3] = _summed(weight * height, factor)
    return moment_field


def _summed(slab: Float, factor: int) -> Float:
    """(ny, nz) sums over blocks of a slab, (factor, ny · factor, nz · factor)."""
    _, ny, nz = slab.shape
    split = slab.reshape(factor, ny // factor, factor, nz // factor, factor)
    result: Float = split.sum(axis=(0, 2, 4))
    return result
