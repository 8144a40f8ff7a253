"""Signed distance to a solid's surface: exact near the level that matters, interpolated elsewhere.

Distance is 1-Lipschitz, so the error of linear interpolation between cell centres yᵢ of pitch P is
at most Σ wᵢ |x − yᵢ| ≤ √3/2 · P.  A cell farther than that from a level is certainly on the right
side of it, and needs no exact value.  (Adaptively sampled distance fields, Frisken et al. 2000,
refine by the same idea.)
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.grid import axis_mm, points_mm, subdivided
from printprep.mesh.aabb_tree import SurfaceTree, tree_of
from printprep.mesh.quantize import quantized_arrays
from printprep.mesh.winding_columns import crossings_of, winding_in_closed
from printprep.types import Grid

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Float, Int

    Float32 = NDArray[np.float32]

# Largest error of trilinear interpolation of a 1-Lipschitz function, in pitches of the coarser
# grid: half the diagonal of a cell.
LIPSCHITZ = float(np.sqrt(3) / 2)


@dataclass(frozen=True, eq=False)
class Surface:
    """A closed surface as arrays: vertices (n, 3) float64 mm, faces (m, 3) int64."""

    vertices: Float
    faces: Int

    @staticmethod
    def of(manifold: Manifold) -> Surface:
        """The surface of a manifold as files hold it, voids included; checks use its tree too."""
        return Surface(*quantized_arrays(manifold))

    def distance_mm(self, points: Float) -> Float:
        """(k,) mm, unsigned exact distance of points (k, 3) mm to the surface, inf if empty."""
        return self._tree.nearest(points)[0] if len(self.faces) else np.full(len(points), np.inf)

    @cached_property
    def _tree(self) -> SurfaceTree:
        return tree_of(self.vertices, self.faces)

    def contains(self, points: Float) -> NDArray[np.bool_]:
        """(k,) whether points (k, 3) mm lie inside, by the exact winding number along verticals."""
        return self._inside(points[:, :2], np.arange(len(points)), points[:, 2])

    def contains_cells(self, grid: Grid, index: Int) -> NDArray[np.bool_]:
        """(k,) whether the centres of cells lie inside; index : (k,) flat indices of the cells.

        The cells of a column share one vertical.
        """
        points = points_mm(grid, index)
        _, first, column = np.unique(index // grid.shape[2], return_index=True, return_inverse=True)
        return self._inside(points[first, :2], np.ravel(column), points[:, 2])

    def inside_grid(self, grid: Grid) -> NDArray[np.bool_]:
        """(nx, ny, nz) whether the centre of each cell lies inside."""
        nx, ny, nz = grid.shape
        x, y = (axis_mm(grid, axis) for axis in (0, 1))
        columns = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        found = crossings_of(self.vertices, self.faces, self._jittered(columns))
        # A crossing counts for all cells below it
        last = np.floor((found.z_mm - grid.origin_mm[2]) / grid.pitch_mm).astype(np.int64)
        reached = last >= 0
        winding = np.zeros((nx * ny, nz), dtype=np.int16)
        at = (found.column[reached], np.minimum(last[reached], nz - 1))
        np.add.at(winding, at, found.sign[reached].astype(np.int16))
        above = winding[:, ::-1].cumsum(axis=1, dtype=np.int16)[:, ::-1]
        result: NDArray[np.bool_] = (above > 0).reshape(grid.shape)
        return result

    def _inside(self, columns: Float, column_of: Int, z_mm: Float) -> NDArray[np.bool_]:
        """(k,) whether points on verticals lie inside.

        columns : (c, 2) mm;  column_of : (k,);  z_mm : (k,).
        """
        columns = self._jittered(columns)
        winding = winding_in_closed(self.vertices, self.faces, columns, column_of, z_mm)
        result: NDArray[np.bool_] = winding > 0.5
        return result

    def _jittered(self, columns: Float) -> Float:
        """Verticals (c, 2) mm moved by a millionth of the surface's size.

        Symmetric models have corners exactly above cell centres.
        """
        size = float(np.ptp(self.vertices, axis=0).max()) if len(self.vertices) else 0.0
        return columns + np.random.default_rng(0).uniform(-1e-6, 1e-6, columns.shape) * size

    def depth_mm(self, points: Float) -> Float:
        """(k,) mm, signed distance of points (k, 3) mm, positive inside."""
        distance = self.distance_mm(points)
        return np.where(self.contains(points), distance, -distance)


@dataclass(frozen=True, eq=False)
class DepthField:
    """Depth below the surface at the cell centres of a grid.

    depth_mm : (nx, ny, nz) float32, positive inside.
    """

    grid: Grid
    depth_mm: Float32


def coarse_depth(surface: Surface, grid: Grid) -> DepthField:
    """Depth at every cell of a grid: exact inside and in a band of two cells outside.

    Farther outside only the sign is exact; the value is minus two pitches.
    """
    from scipy.ndimage import binary_dilation

    inside = surface.inside_grid(grid)
    near = binary_dilation(inside, structure=np.ones((3, 3, 3)), iterations=2)
    depth = np.full(grid.shape, -2 * grid.pitch_mm, dtype=np.float32)
    index = np.flatnonzero(near)
    distance = surface.distance_mm(points_mm(grid, index))
    depth.flat[index] = np.where(inside.flat[index], distance, -distance)
    return DepthField(grid, depth)


def refine(surface: Surface, field: DepthField, factor: int, level_mm: float) -> DepthField:
    """The field on cells ``factor`` times smaller, exact near one level.

    level_mm : the depth at which a surface will be extracted.
    """
    fine = subdivided(field.grid, factor)
    depth = upsampled(field.depth_mm, factor)
    slack = LIPSCHITZ * field.grid.pitch_mm
    # Cells outside the band must stay right for their own sub-cells too: one more half diagonal.
    band = slack + LIPSCHITZ * fine.pitch_mm
    index = np.flatnonzero(np.abs(depth - np.float32(level_mm)) <= band)
    estimate = depth.flat[index]
    points = points_mm(fine, index)
    exact = surface.distance_mm(points)
    unsure = estimate <= slack
    outside = np.zeros(len(index), dtype=bool)
    outside[unsure] = ~surface.contains_cells(fine, index[unsure])
    depth.flat[index] = np.where(outside, -exact, exact)
    return DepthField(fine, depth)


def signed(surface: Surface, field: DepthField, grid: Grid) -> DepthField:
    """Depth on a finer grid: its sign is exact, its value interpolated.

    field : on cells that are each a whole number of cells of ``grid`` wide, from the same corner.
    """
    factor = round(field.grid.pitch_mm / grid.pitch_mm)
    nx, ny, nz = grid.shape
    depth = np.abs(upsampled(field.depth_mm, factor)[:nx, :ny, :nz])
    return DepthField(grid, np.where(surface.inside_grid(grid), depth, -depth))


def upsampled(values: Float32, factor: int) -> Float32:
    """(nx·f, ny·f, nz·f) linear interpolation of (nx, ny, nz) at the centres of f³ sub-cells."""
    for axis in range(3):
        values = _upsample_axis(values, factor, axis)
    return values


def _upsample_axis(values: Float32, factor: int, axis: int) -> Float32:
    """The same along one axis of values (nx, ny, nz)."""
    values = np.moveaxis(values, axis, 0)
    count = values.shape[0]
    out = np.empty((count * factor, *values.shape[1:]), dtype=np.float32)
    below = np.concatenate([values[:1], values[:-1]])
    above = np.concatenate([values[1:], values[-1:]])
    for phase in range(factor):
        offset = (phase + 0.5) / factor - 0.5
        other = below if offset < 0 else above
        weight = np.float32(abs(offset))
        out[phase::factor] = values * (1 - weight) + other * weight
    return np.moveaxis(out, 0, axis)
