"""Measures depth below the surface: on the grid of the optimization, and finer near the wall.

The free interior is the space deeper than the wall, in mm and not in voxels (method.md); the field
that decides it is several times finer than the grid.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.balls import deepest_points
from printprep.grid.distance import LIPSCHITZ, DepthField, Surface, coarse_depth, refine, signed
from printprep.grid.grid import block_around, coarsened, cropped, grid_over
from printprep.types import Grid

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float
    from printprep.types import Solid


# Cells of the fine field per wall: at two, the facets of a surface of curvature radius `wall` stay
# within (wall/2)²·2/(8·wall) = 0.063 wall of it, which the cavity's surface corrects.
CELLS_PER_WALL = 1.5
# Most cells along the longest side: 57 million cells in all, 230 MB.
MOST_FINE_CELLS = 384


@dataclass(frozen=True, eq=False)
class Depths:
    """Depth below a solid's surface, in mm, positive inside.

    coarse : on the grid of the optimization; on a grid finer than the field only its sign is exact.
    field : of cells a fraction of a wall wide, over the block that holds all points deeper than the
    wall; pockets too small for the minimum feature are closed already.  None where no point is that
    deep.
    measured : on the grid that distances were measured on, where that is wider than ``coarse``.
    """

    coarse: DepthField
    field: DepthField | None
    measured: DepthField | None = None

    @property
    def grid(self) -> Grid:
        """The grid of the optimization."""
        return self.coarse.grid

    def for_estimates(self) -> Depths:
        """The same on the widest grid, for what needs no fine one."""
        return self if self.measured is None else Depths(self.measured, self.field)


def measure_depths(
    solid: Solid,
    *,
    resolution: int,
    wall_mm: float,
    min_feature_mm: float,
    margin_mm: float = 0.0,
    cells_per_wall: float = CELLS_PER_WALL,
) -> Depths:
    """Voxelize a solid and measure the depth below its surface.

    Parameters
    ----------
    resolution : voxels along the longest side, the paper's N (64).
    wall_mm : the depth at which a cavity may begin.
    min_feature_mm : a pocket that cannot hold a ball of this diameter stays solid.
    margin_mm : empty margin of the grid around the solid in x and y.
    cells_per_wall : cells of the fine field in the thickness of the wall.
    """
    surface = Surface.of(solid.manifold)
    box = np.array(solid.manifold.bounding_box())
    # A base grows no wider than a model is long: small models would else drown in margin.
    margin_mm = min(margin_mm, float((box[3:] - box[:3]).max()))
    grid = grid_over(box[:3], box[3:], resolution, margin_mm)
    wide = None
    cell_mm = max(wall_mm / cells_per_wall, max(grid.shape) * grid.pitch_mm / MOST_FINE_CELLS)
    if grid.pitch_mm > cell_mm:
        coarse = coarse_depth(surface, grid)
        field = _fine_field(surface, coarse, wall_mm, cell_mm)
    else:
        # The grid is finer than the surface needs: distances are measured on one that is not
        wide = coarse_depth(surface, coarsened(grid, 2 * _largest_power(cell_mm / grid.pitch_mm)))
        field = _fine_field(surface, wide, wall_mm, cell_mm)
        coarse = signed(surface, wide, grid)
    if field is not None:
        field = close_small_pockets(surface, field, wall_mm, min_feature_mm)
    return Depths(coarse, field, wide)


def _fine_field(
    surface: Surface, coarse: DepthField, wall_mm: float, cell_mm: float
) -> DepthField | None:
    """The field with cells of ``cell_mm``, over the block that holds all points below the wall."""
    pitch = coarse.grid.pitch_mm
    maybe = coarse.depth_mm > wall_mm - pitch
    if not maybe.any():
        return None
    block = block_around(maybe, margin=1)
    field = DepthField(cropped(coarse.grid, block), coarse.depth_mm[block])
    for factor in _factors(pitch / cell_mm):
        field = refine(surface, field, factor, wall_mm)
    return field if bool((field.depth_mm > wall_mm).any()) else None


def _largest_power(ratio: float) -> int:
    """The largest power of two that is at most a ratio, 1 or more."""
    return int(2 ** np.floor(np.log2(ratio)))


def _factors(ratio: float) -> tuple[int, ...]:
    """Factors 2 and 3, the larger last, with the smallest product that is at least ``ratio``."""
    best: tuple[int, ...] = ()
    best_product = float("inf")
    for threes in range(5):
        twos = max(0, int(np.ceil(np.log2(max(ratio, 1.0) / 3**threes) - 1e-9)))
        product = 2**twos * 3**threes
        if product < best_product:
            best, best_product = (2,) * twos + (3,) * threes, product
    return best


def close_small_pockets(
    surface: Surface, field: DepthField, wall_mm: float, min_feature_mm: float
) -> DepthField | None:
    """The field without pockets that cannot hold a ball of the minimum feature.

    None where no pocket is left.
    """
    from scipy.ndimage import label

    pocket, count = label(field.depth_mm > wall_mm)
    roomy = np.unique(pocket[field.depth_mm >= wall_mm + min_feature_mm / 2])
    small = np.ones(count + 1, dtype=bool)
    small[[0, *roomy]] = False
    # Between cell centres a pocket is at most half a cell's diagonal deeper than at them.
    pitch, enough = field.grid.pitch_mm, wall_mm + min_feature_mm / 2
    hopeful = np.unique(pocket[field.depth_mm >= enough - LIPSCHITZ * pitch])
    doubtful = hopeful[small[hopeful] & (hopeful > 0)]
    if len(doubtful):
        starts = _peaks(pocket, doubtful, field)
        _, depth = deepest_points(surface.distance_mm, starts, pitch, enough)
        small[doubtful] = depth < enough
    if not small.any():
        return field
    if small[1:].all():
        return None
    closed = np.where(small[pocket], np.float32(wall_mm - field.grid.pitch_mm / 2), field.depth_mm)
    return DepthField(field.grid, closed)


def _peaks(pocket: NDArray[np.int32], numbers: NDArray[np.intp], field: DepthField) -> Float:
    """(k, 3) mm, deepest cell centre of each pocket.

    pocket : (nx, ny, nz) number of each cell's pocket;  numbers : (k,) the pockets.
    """
    from scipy.ndimage import find_objects

    boxes = find_objects(pocket)
    peaks = []
    for number in numbers:
        box = boxes[number - 1]
        inside = np.where(pocket[box] == number, field.depth_mm[box], -np.inf)
        peak = np.unravel_index(int(np.argmax(inside)), inside.shape)
        peaks.append([axis.start + at for axis, at in zip(box, peak, strict=True)])
    return field.grid.origin_mm + field.grid.pitch_mm * np.array(peaks)
