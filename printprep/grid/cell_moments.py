"""Volume and first moments of a solid in every cell of a grid, by dexels.

A dexel is the stretch of a vertical line that lies inside (van Hook, SIGGRAPH 1986).  One line runs
through a random point in each of n × n parts of every cell's footprint.  Along z the integrals are
exact; across, the jitter turns the error at upright walls from systematic to random, and a wall
meets hundreds of lines.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.grid import axis_mm
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
    i, j = np.divmod(column, ny * lines)
    pillar = np.ravel_multi_index((i // lines, j // lines), (nx, ny))
    weights = (np.ones(len(column)), columns[column, 0], columns[column, 1])

    # The cells in which a dexel begins and ends
    begins = np.minimum(high, bottom + (first + 1) * grid.pitch_mm)
    split = last > first
    ends = bottom + last[split] * grid.pitch_mm
    cell = np.concatenate([pillar * nz + first, (pillar * nz + last)[split]])
    length = np.concatenate([begins - low, high[split] - ends])
    middle = np.concatenate([low + begins, ends + high[split]]) / 2
    for row, weight in enumerate(weights):
        both = np.concatenate([weight, weight[split]]) * length
        result[row] = np.bincount(cell, both, nx * ny * nz).reshape(grid.shape)
    result[3] = np.bincount(cell, length * middle, nx * ny * nz).reshape(grid.shape)

    # The cells between, which it fills from floor to ceiling: counted up from the bottom
    edge = np.concatenate([pillar * nz + first + 1, pillar * nz + last])[np.tile(split, 2)]
    for row, weight in enumerate(weights):
        steps = np.concatenate([weight, -weight])[np.tile(split, 2)]
        full = np.bincount(edge, steps, nx * ny * nz).reshape(grid.shape).cumsum(axis=2)
        result[row] += full * grid.pitch_mm
        if row == 0:
            result[3] += np.rint(full) * grid.pitch_mm * axis_mm(grid, 2)
    result *= spacing**2
    return result
