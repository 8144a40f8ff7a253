"""The empty space in and around a part, on a grid, and where the centre of a ball fits in it.

Notation: p pitch, r the ball's radius, c(x) the clearance of a point: its distance to the material.

A ball fits where c ≥ r.  A Euclidean distance transform gives the clearance to the centres of full
cells everywhere at once, but only to about half a cell.  A hole as wide as the ball leaves its
centre one line only, which passes between cell centres.  So on ridges of the clearance, where that
decides, the largest clearance within a cell is measured on the triangles themselves: a hole of the
ball's own diameter lets it through, one a twentieth narrower does not.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.cell_distance import cell_distance
from printprep.grid.grid import cropped, points_mm
from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.measure import arrays
from printprep.mesh.winding_columns import crossings_of
from printprep.types import Grid

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Bool, Float, Int

    Float32 = NDArray[np.float32]

# The largest error of the clearance to cell centres, less half a cell, in pitches.
_UNSURE = 1.3
# A cell whose neighbours have this much more clearance (in pitches) lies on a slope, not a ridge.
_SLOPE = 0.6
_MOUTH = 4
# Steps of the search within a cell, in pitches: it ends a hundredth of a pitch from the maximum.
_STEPS = (0.25, 0.125, 0.0625, 0.03125, 0.015)
# A ball that fits with this share of its radius fits: the facets of a round hole cut into the rest.
FITS = 0.99


@dataclass(frozen=True, eq=False)
class Clearance:
    """Clearance of the cells around a part; arrays of the grid's shape (nx, ny, nz).

    empty : bool, True where the cell's centre lies in no material.
    clearance_mm : float32, distance of empty cells to material, to about half a cell; 0 in full
    cells.
    surface : the part's.
    """

    grid: Grid
    empty: Bool
    clearance_mm: Float32
    surface: SurfaceTree

    def within(self, block: tuple[slice, slice, slice]) -> Clearance:
        """The clearance in a block of cells."""
        grid = cropped(self.grid, block)
        return Clearance(grid, self.empty[block], self.clearance_mm[block], self.surface)

    def ball_fits(self, radius_mm: float) -> Bool:
        """(nx, ny, nz) bool, the cells where the centre of a ball of this radius fits."""
        pitch, clearance = self.grid.pitch_mm, self.clearance_mm
        fits: Bool = clearance >= radius_mm + 0.3 * pitch
        doubtful = self.empty & (np.abs(clearance - radius_mm) <= _UNSURE * pitch)
        wanted = FITS * radius_mm
        index = np.flatnonzero(doubtful)
        index = index[~_on_slope(clearance, index, _SLOPE * pitch)]
        for _ in range(_MOUTH):
            doubtful.flat[index] = False
            tight = index[self.largest_mm(index, wanted) >= wanted]
            fits.flat[tight] = True
            # At the mouth of a hole the ridge runs up a slope, over three cells at most.
            beside = np.unique(_beside(tight, fits.shape))
            index = beside[doubtful.flat[beside] & ~fits.flat[beside]]
        return fits

    def largest_mm(self, index: Int, enough_mm: float = np.inf) -> Float:
        """(n,) mm, the largest clearance within each cell, or one that is enough.

        index : (n,) flat.
        """
        if len(index) == 0:
            return np.zeros(0)
        pitch = self.grid.pitch_mm
        centres = points_mm(self.grid, index)
        points, best = centres.copy(), self.surface.nearest(centres)[0]
        star = np.vstack([np.eye(3), -np.eye(3)])
        for share in _STEPS:
            # A search goes on only where steps this small and smaller can still gain enough.
            gain = 2 * np.sqrt(3) * share * pitch
            for _ in range(2):
                going = np.flatnonzero(
                    (best < enough_mm) & (~np.isfinite(enough_mm) | (best + gain >= enough_mm))
                )
                if len(going) == 0:
                    return best
                around = points[going, None] + share * pitch * star
                limit = pitch / 2
                around = np.clip(around, centres[going, None] - limit, centres[going, None] + limit)
                found = self.surface.nearest(around.reshape(-1, 3))[0].reshape(
                    len(going), len(star)
                )
                top = found.argmax(axis=1)
                highest = found[np.arange(len(going)), top]
                better = highest > best[going]
                moved = going[better]
                points[moved] = around[better, top[better]]
                best[moved] = highest[better]
        return best


def space_around(part: Manifold, pitch_mm: float, margin_mm: float) -> Clearance:
    """Measure the clearance in a part's bounding box and a margin around it."""
    grid, empty = empty_cells(part, pitch_mm, margin_mm, margin_mm)
    cells = np.maximum(cell_distance(empty) - np.float32(0.5), 0)
    clearance: Float32 = cells * np.float32(pitch_mm)
    return Clearance(grid, empty, clearance, SurfaceTree(*arrays(part)))


def empty_cells(
    part: Manifold, pitch_mm: float, margin_mm: float, below_mm: float
) -> tuple[Grid, Bool]:
    """Find the cells in a part's box and a margin around it that lie in no material.

    below_mm : the margin under the part; with 0, the first layer of cells stands on its lowest
    point.
    Returns the grid, and (nx, ny, nz) bool, True where the cell's centre lies in no material.
    """
    low, high = np.reshape(part.bounding_box(), (2, 3))
    around, under = (int(np.ceil(mm / pitch_mm)) for mm in (margin_mm, below_mm))
    cells = np.maximum(np.ceil((high - low) / pitch_mm - 1e-9).astype(int), 1)
    start = low - (cells * pitch_mm - (high - low)) / 2
    start[2] = low[2]
    nx, ny, nz = (cells + np.array([2 * around, 2 * around, around + under])).tolist()
    origin = start + pitch_mm / 2 - pitch_mm * np.array([around, around, under])
    grid = Grid(origin, pitch_mm, (nx, ny, nz))
    return grid, ~_filled(*arrays(part), grid)


def _filled(vertices: Float, faces: Int, grid: Grid) -> Bool:
    """(nx, ny, nz) bool, the cells whose centres lie in material, by crossings of their columns.

    vertices : (v, 3) mm;  faces : (f, 3).
    """
    nx, ny, nz = grid.shape
    x, y = (grid.origin_mm[a] + grid.pitch_mm * np.arange(grid.shape[a]) for a in (0, 1))
    columns = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    # Symmetric models have corners exactly above cell centres.
    reach = 1e-6 * float(np.ptp(vertices, axis=0).max())
    columns = columns + np.random.default_rng(0).uniform(-reach, reach, columns.shape)
    found = crossings_of(vertices, faces, columns)
    layer = np.ceil((found.z_mm - grid.origin_mm[2]) / grid.pitch_mm)
    layer = np.clip(layer, 0, nz).astype(np.int64)
    # Upward, material begins where the surface faces down and ends where it faces up.
    change = np.zeros((nx * ny, nz + 1), dtype=np.int16)
    np.subtract.at(change, (found.column, layer), found.sign.astype(np.int16))
    inside: Bool = np.cumsum(change[:, :nz], axis=1, dtype=np.int16) > 0
    return inside.reshape(grid.shape)


def _on_slope(clearance: Float32, index: Int, rise_mm: float) -> Bool:
    """(n,) bool, which cells have a neighbour with so much more clearance.

    clearance : (nx, ny, nz) mm;  index : (n,) flat.
    """
    around = clearance.flat[_beside(index, clearance.shape)]
    steep: Bool = around.max(axis=0) > clearance.flat[index] + rise_mm
    return steep


def _beside(index: Int, shape: tuple[int, ...]) -> Int:
    """(27, n) flat indices of each cell (n,) and the cells around it; clipped at the edges."""
    at = np.unravel_index(index, shape)
    return np.stack(
        [
            np.ravel_multi_index(
                [np.clip(a + s - 1, 0, n - 1) for a, s, n in zip(at, step, shape, strict=True)],
                shape,
            )
            for step in np.ndindex(3, 3, 3)
        ]
    )
