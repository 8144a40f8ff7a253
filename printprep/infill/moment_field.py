"""The room that infill fills, weighed where depth is already measured: no surface has to be drawn.

A cell of the fine field counts by the share of it that lies deeper than the level, taken linear in
the depth of its middle.  What a column loses from one cell to the next above is its ceiling.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.domain import Interior, interior_of
from printprep.grid.grid import axis_mm

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.grid.depth import Depths
    from printprep.types import Solid


@dataclass(frozen=True, eq=False)
class MomentField:
    """What lies deeper than a level, by the cells of the optimization's grid.

    volume : (4, nx, ny, nz) mm³ and first moments in mm⁴;  ceiling : (4, nx, ny, nz) area in plan,
    mm², of all that faces the room from above, and its first moments in mm³.
    """

    volume: Float
    ceiling: Float

    def interior(self, solid: Solid, depths: Depths) -> Interior:
        """The room as the program's free voxels."""
        return interior_of(solid, depths, self.volume)


def moment_field_of(depths: Depths, level_mm: float) -> MomentField:
    """The room deeper than a level; none where nothing is measured to be that deep."""
    grid = depths.grid
    room = MomentField(np.zeros((4, *grid.shape)), np.zeros((4, *grid.shape)))
    field = depths.field
    if field is None:
        return room
    fine = field.grid
    factor = round(grid.pitch_mm / fine.pitch_mm)
    middle = fine.origin_mm + (grid.pitch_mm - fine.pitch_mm) / 2
    first = np.rint((middle - grid.origin_mm) / grid.pitch_mm).astype(int)
    nx, ny, nz = (count // factor for count in fine.shape)
    block = np.s_[first[1] : first[1] + ny, first[2] : first[2] + nz]
    x, y, z = (axis_mm(fine, axis) for axis in range(3))
    for i in range(nx):  # a slab at a time: the field is large
        slab = slice(i * factor, (i + 1) * factor)
        deeper = (field.depth_mm[slab].astype(float) - level_mm) / fine.pitch_mm
        share = np.clip(deeper + 0.5, 0.0, 1.0)
        above = np.concatenate([share[:, :, 1:], np.zeros_like(share[:, :, :1])], axis=2)
        lost = np.maximum(share - above, 0.0)
        for out, weight, height in (
            (room.volume, share * fine.pitch_mm**3, z),
            (room.ceiling, lost * fine.pitch_mm**2, z + fine.pitch_mm / 2),
        ):
            cells = out[(slice(None), first[0] + i, *block)]
            cells[0] = _summed(weight, factor)
            cells[1] = _summed(weight * x[slab][:, None, None], factor)
            cells[2] = _summed(weight * y[:, None], factor)
            cells[3] = _summed(weight * height, factor)
    return room


def _summed(slab: Float, factor: int) -> Float:
    """(ny, nz) sums over the cells of a slab, ``factor`` cells thick."""
    _, ny, nz = slab.shape
    split = slab.reshape(factor, ny // factor, factor, nz // factor, factor)
    result: Float = split.sum(axis=(0, 2, 4))
    return result
