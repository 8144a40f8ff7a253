"""From a solid to the domain of the optimization: shell, interior, free voxels and their weights.

The free voxels are those deeper than the wall (method.md: walls are in mm, not voxels).  Their
weights are taken from a field several times finer than the grid, so that what the linear program
weighs is what the cavity surface will enclose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies
from printprep.types import Domain, Grid
from printprep.voxel.balls import deepest_points
from printprep.voxel.distance import LIPSCHITZ, DepthField, Surface, coarse_depth, refine
from printprep.voxel.grid import (
    axis_mm,
    block_around,
    cropped,
    grid_over,
    points_mm,
)

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.types import Solid

    Float = NDArray[np.float64]

# Cells of the fine field per wall: at three, the facets of a surface of curvature radius `wall`
# stay within (wall/3)²·2/(8·wall) = 0.028 wall of it.
CELLS_PER_WALL = 3.0
# And no more cells along the longest side than this: 57 million at most, 230 MB.
MOST_FINE_CELLS = 384


@dataclass(frozen=True, eq=False)
class Interior:
    """The room there is for a cavity, as a fine field and as weighted voxels.

    domain : the voxels.
    field : depth at a grid several times finer, over the block that holds the interior; pockets
    too small for the minimum feature are already closed.  None when there is no interior.
    moments : (4, n) volume in mm³ and first moments in mm⁴ of the void in each free voxel, in the
    C order of ``domain.free``.
    """

    domain: Domain
    field: DepthField | None
    moments: NDArray[np.float64]


def build_interior(
    solid: Solid, *, resolution: int, wall_mm: float, min_feature_mm: float, margin_mm: float = 0.0
) -> Interior:
    """Voxelize a solid and find what may be hollowed.

    Parameters
    ----------
    resolution : voxels along the longest side, the paper's N (64).
    wall_mm : least thickness of material between a cavity and any surface of the solid.
    min_feature_mm : a pocket that cannot hold a ball of this diameter stays solid.
    margin_mm : room on the grid around the solid in x and y.
    """
    surface = Surface.of(solid.manifold)
    box = np.array(solid.manifold.bounding_box())
    grid = grid_over(box[:3], box[3:], resolution, margin_mm)
    coarse = coarse_depth(surface, grid)
    occupied = coarse.depth_mm > 0
    field = _fine_field(surface, coarse, wall_mm)
    if field is not None:
        field = close_small_pockets(surface, field, wall_mm, min_feature_mm)
    share, centroid = _shares(grid, field, wall_mm)
    free = share > 0
    volume = share[free] * grid.pitch_mm**3
    domain = Domain(
        grid=grid,
        depth_mm=coarse.depth_mm.astype(np.float64),
        shell=occupied & ~free,
        interior=free,
        base=np.zeros(grid.shape, dtype=bool),
        free=free,
        share=share,
        body=_body_of_cells(solid.manifold, grid, occupied | free),
    )
    moments = np.vstack([volume, volume * centroid[:, free]])
    return Interior(domain, field, moments)


def with_base(domain: Domain, base: Manifold) -> Domain:
    """The domain with the voxels of a base marked."""
    index = np.arange(domain.free.size)
    inside = Surface.of(base).contains(points_mm(domain.grid, index)).reshape(domain.grid.shape)
    return replace(domain, base=inside & (domain.body < 0))


def _fine_field(surface: Surface, coarse: DepthField, wall_mm: float) -> DepthField | None:
    """The field fine enough for the wall, over the block that holds everything deeper than it."""
    pitch = coarse.grid.pitch_mm
    maybe = coarse.depth_mm > wall_mm - pitch
    if not maybe.any():
        return None
    block = block_around(maybe, margin=1)
    field = DepthField(cropped(coarse.grid, block), coarse.depth_mm[block])
    longest = max(coarse.grid.shape) * pitch
    target = max(wall_mm / CELLS_PER_WALL, longest / MOST_FINE_CELLS)
    for factor in _factors(pitch / target):
        field = refine(surface, field, factor, wall_mm)
    return field if bool((field.depth_mm > wall_mm).any()) else None


def _factors(ratio: float) -> tuple[int, ...]:
    """Factors of 2 and 3, largest last, whose product is the least that reaches ``ratio``."""
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
    """The field with every pocket closed that cannot hold a ball of the minimum feature."""
    from scipy.ndimage import label

    pocket, count = label(field.depth_mm > wall_mm)
    roomy = np.unique(pocket[field.depth_mm >= wall_mm + min_feature_mm / 2])
    small = np.ones(count + 1, dtype=bool)
    small[[0, *roomy]] = False
    # Between cell centres a pocket is deeper than at them by half a cell's diagonal at most.
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
    """(k, 3) where the field is deepest in each of these pockets."""
    from scipy.ndimage import find_objects

    boxes = find_objects(pocket)
    peaks = []
    for number in numbers:
        box = boxes[number - 1]
        inside = np.where(pocket[box] == number, field.depth_mm[box], -np.inf)
        peak = np.unravel_index(int(np.argmax(inside)), inside.shape)
        peaks.append([axis.start + at for axis, at in zip(box, peak, strict=True)])
    return field.grid.origin_mm + field.grid.pitch_mm * np.array(peaks)


def _shares(
    grid: Grid, field: DepthField | None, wall_mm: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Share of each cell deeper than the wall, and the centroid (3, …) of that share, mm."""
    share = np.zeros(grid.shape)
    centroid = np.zeros((3, *grid.shape))
    if field is None:
        return share, centroid
    factor = round(grid.pitch_mm / field.grid.pitch_mm)
    fraction = np.clip(
        np.float32(0.5) + (field.depth_mm - np.float32(wall_mm)) / field.grid.pitch_mm, 0, 1
    )
    nx, ny, nz = (count // factor for count in field.grid.shape)
    parts = fraction.reshape(nx, factor, ny, factor, nz, factor)
    local_share = parts.mean(axis=(1, 3, 5), dtype=np.float64)
    offset = (np.arange(factor) - (factor - 1) / 2) * field.grid.pitch_mm
    corner = field.grid.origin_mm + (factor - 1) / 2 * field.grid.pitch_mm
    first = np.round((corner - grid.origin_mm) / grid.pitch_mm).astype(int)
    x, y, z = (slice(int(f), int(f) + n) for f, n in zip(first, (nx, ny, nz), strict=True))
    block = x, y, z
    share[block] = local_share
    some = np.maximum(local_share, 1e-300)
    for axis, keep in enumerate(((3, 5), (1, 5), (1, 3))):
        sums = parts.mean(axis=keep, dtype=np.float64)
        shift = np.moveaxis(sums, axis + 1, -1) @ offset / factor
        local = axis_mm(grid, axis)[block[axis]]
        shape = [1, 1, 1]
        shape[axis] = -1
        centroid[axis][block] = local.reshape(shape) + shift / some
    return share, centroid


def _body_of_cells(manifold: Manifold, grid: Grid, cells: NDArray[np.bool_]) -> NDArray[np.int64]:
    """Which disjoint body each cell belongs to, −1 where none."""
    result = np.full(grid.shape, -1, dtype=np.int64)
    parts = bodies(manifold)
    if len(parts) == 1:
        result[cells] = 0
        return result
    index = np.flatnonzero(cells)
    points = points_mm(grid, index)
    distance = np.stack(
        [
            np.where(part.contains(points), -1.0, 1.0) * part.distance_mm(points)
            for part in map(Surface.of, parts)
        ]
    )
    result.flat[index] = np.argmin(distance, axis=0)
    return result
