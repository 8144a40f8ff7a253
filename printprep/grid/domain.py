"""The domain of the optimization: shell, interior and free voxels, with their moments.

The moments are those of the hollowable volume as it will be cut, without its supports, so that the
linear program weighs exactly what the surface of a cavity will enclose.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.cell_moments import moments_in_cells
from printprep.grid.depth import Depths
from printprep.grid.distance import Surface
from printprep.grid.grid import points_mm
from printprep.mesh.measure import bodies
from printprep.types import Domain, Grid

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Float
    from printprep.types import Solid


# Dexel lines per edge of a cell: their distance is about a third of a wall, as is that of the
# samples from which the surface is extracted.
LINES = 4


@dataclass(frozen=True, eq=False)
class Interior:
    """The hollowable volume as weighted voxels.

    moments : (4, n) volume in mm³ and first moments in mm⁴ of the hollowable volume in each free
    voxel, in the C order of ``domain.free``.
    """

    domain: Domain
    moments: Float


def weigh_interior(solid: Solid, depths: Depths, hollowable_volume: Manifold) -> Interior:
    """The domain of a solid; its free voxels are those that reach into the hollowable volume.

    Parameters
    ----------
    hollowable_volume : everything that may become cavity, a manifold inside the solid.
    """
    return interior_of(solid, depths, moments_in_cells(hollowable_volume, depths.grid, LINES))


def interior_of(solid: Solid, depths: Depths, moments: Float) -> Interior:
    """The same from moments (4, nx, ny, nz) of the hollowable volume in every cell."""
    grid = depths.grid
    share = moments[0] / grid.pitch_mm**3
    occupied = depths.coarse.depth_mm > 0
    free = share > 0
    domain = Domain(
        grid=grid,
        depth_mm=depths.coarse.depth_mm.astype(np.float64),
        shell=occupied & ~free,
        interior=free,
        base=np.zeros(grid.shape, dtype=bool),
        free=free,
        share=share,
        body=_body_of_cells(solid.manifold, grid, occupied | free),
    )
    return Interior(domain, moments[:, free])


def reweighed(interior: Interior, hollowable_volume: Manifold) -> Interior:
    """The same solid with a smaller hollowable volume."""
    domain = interior.domain
    moments = moments_in_cells(hollowable_volume, domain.grid, LINES)
    share = moments[0] / domain.grid.pitch_mm**3
    free = share > 0
    changed = replace(
        domain, shell=(domain.depth_mm > 0) & ~free, interior=free, free=free, share=share
    )
    return Interior(changed, moments[:, free])


def with_base(domain: Domain, base: Manifold) -> Domain:
    """The domain with the voxels of a base marked."""
    index = np.arange(domain.free.size)
    inside = Surface.of(base).contains_cells(domain.grid, index).reshape(domain.grid.shape)
    return replace(domain, base=inside & (domain.body < 0))


def _body_of_cells(manifold: Manifold, grid: Grid, cells: NDArray[np.bool_]) -> NDArray[np.int64]:
    """(nx, ny, nz) index of the body that each True cell (nx, ny, nz) belongs to, −1 elsewhere."""
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
