"""Volume and first moments of a solid in every cell of a grid, by dexels.

A dexel is the stretch of a vertical line that lies inside (van Hook, SIGGRAPH 1986).  One line runs
through a random point in each of n × n parts of every cell's footprint.  Along z the integrals are
exact; across, the jitter turns the error at upright walls from systematic to random, and a wall
meets hundreds of lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs
from printprep.mesh.measure import arrays
from printprep.mesh.winding_columns import crossings_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.types import Grid


def moments_in_cells(manifold: Manifold, grid: Grid, lines: int = 4) -> Float:
    """Volume in mm³ and first moments in mm⁴ of a solid in every cell.

    Parameters
    ----------
    lines : per edge of a cell, so lines² through each cell.

    Returns
    -------
    (4, nx, ny, nz) float64: volume, and volume times x, y, z of its centroid.
    """
    nx, ny, nz = grid.shape
    result = np.zeros((4, nx, ny, nz))
    if manifold.is_empty():
        return result
    spacing = grid.pitch_mm / lines
    x, y = (
        grid.origin_mm[axis] + ((np.arange(count * lines) + 0.5) / lines - 0.5) * grid.pitch_mm
        for axis, count in ((0, nx), (1, ny))
    )
    columns = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    columns += np.random.default_rng(0).uniform(-spacing / 2, spacing / 2, columns.shape)
    crossings = crossings_of(*arrays(manifold), columns)
    # Sorted by column, then upward: crossings enter and leave the solid in turn.
    column, low, high = crossings.column[::2], crossings.z_mm[::2], crossings.z_mm[1::2]
    if len(crossings.z_mm) % 2 or not np.array_equal(column, crossings.column[1::2]):
        raise ArithmeticError("a line enters a closed surface and does not leave it")
    bottom = grid.origin_mm[2] - grid.pitch_mm / 2
    first = np.clip(np.floor((low - bottom) / grid.pitch_mm).astype(int), 0, nz - 1)
    last = np.clip(np.floor((high - bottom) / grid.pitch_mm).astype(int), 0, nz - 1)
    # Every dexel once for every cell that it reaches into.
    dexel, place = runs(last - first + 1)
    layer = place + first[dexel]
    floor = bottom + layer * grid.pitch_mm
    from_, to = np.maximum(low[dexel], floor), np.minimum(high[dexel], floor + grid.pitch_mm)
    volume = np.maximum(to - from_, 0.0) * spacing**2
    line = column[dexel]
    i, j = np.divmod(line, ny * lines)
    cell = np.ravel_multi_index((i // lines, j // lines, layer), grid.shape)
    middle = (1.0, columns[line, 0], columns[line, 1], (from_ + to) / 2)
    for row, coordinate in enumerate(middle):
        result[row] = np.bincount(cell, volume * coordinate, nx * ny * nz).reshape(grid.shape)
    return result
