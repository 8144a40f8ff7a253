"""Regular grids of cubic cells in mm: making, cropping and subdividing them, and their points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.types import Grid

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float


def grid_over(low_mm: Float, high_mm: Float, resolution: int, margin_mm: float = 0.0) -> Grid:
    """A grid with ``resolution`` cells along the longest side of a box, centred on the box.

    Parameters
    ----------
    low_mm, high_mm : (3,) corners of the box.
    resolution : cells along the longest side, the paper's N.
    margin_mm : empty margin around the box in x and y (for a base that grows outward).
    """
    low, high = np.asarray(low_mm, dtype=float), np.asarray(high_mm, dtype=float)
    extents = high - low
    pitch = float(extents.max()) / resolution
    # The slack keeps rounding from adding a cell to a side that is a whole number of cells.
    counts = np.maximum(np.ceil(extents / pitch - 1e-9).astype(int), 1)
    counts[:2] += 2 * int(np.ceil(margin_mm / pitch))
    origin = (low + high) / 2 - (counts - 1) / 2 * pitch
    return Grid(origin, pitch, (int(counts[0]), int(counts[1]), int(counts[2])))


def subdivided(grid: Grid, factor: int) -> Grid:
    """The grid whose cells are ``factor``³ equal parts of each cell of this one."""
    pitch = grid.pitch_mm / factor
    origin = grid.origin_mm - (grid.pitch_mm - pitch) / 2
    nx, ny, nz = grid.shape
    return Grid(origin, pitch, (nx * factor, ny * factor, nz * factor))


def coarsened(grid: Grid, factor: int) -> Grid:
    """The grid of cells ``factor`` times as wide, from the same corner, that covers this one."""
    pitch = grid.pitch_mm * factor
    origin = grid.origin_mm + (pitch - grid.pitch_mm) / 2
    nx, ny, nz = (-(-count // factor) for count in grid.shape)
    return Grid(origin, pitch, (nx, ny, nz))


def cropped(grid: Grid, block: tuple[slice, slice, slice]) -> Grid:
    """The grid of the cells in a block (slices along x, y, z with explicit start and stop)."""
    start = np.array([axis.start for axis in block])
    nx, ny, nz = (axis.stop - axis.start for axis in block)
    return Grid(grid.origin_mm + grid.pitch_mm * start, grid.pitch_mm, (nx, ny, nz))


def block_around(cells: NDArray[np.bool_], margin: int) -> tuple[slice, slice, slice]:
    """Slices along x, y, z of the smallest block that holds all True cells (nx, ny, nz).

    The block is ``margin`` cells wider, as far as the grid goes.  Raises ValueError where no cell
    is True.
    """
    slices = []
    for axis in range(3):
        others = tuple(a for a in range(3) if a != axis)
        hit = np.flatnonzero(cells.any(axis=others))
        if len(hit) == 0:
            raise ValueError("a block needs at least one True cell")
        start = max(int(hit[0]) - margin, 0)
        slices.append(slice(start, min(int(hit[-1]) + 1 + margin, cells.shape[axis])))
    return slices[0], slices[1], slices[2]


def points_mm(grid: Grid, flat_index: NDArray[np.intp]) -> Float:
    """(k, 3) mm, centres of the cells with indices (k,) into the flattened (C order) array."""
    index = np.stack(np.unravel_index(flat_index, grid.shape), axis=1)
    result: Float = grid.origin_mm + grid.pitch_mm * index
    return result


def axis_mm(grid: Grid, axis: int) -> Float:
    """(n,) mm, coordinates of the n cell centres along one axis."""
    result: Float = grid.origin_mm[axis] + grid.pitch_mm * np.arange(grid.shape[axis])
    return result
