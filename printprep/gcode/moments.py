"""Amount, first and second moments of straight stretches of filament, and sums of them.

A stretch is a bar of even density from a to b.  Per unit of filament its moments are
∫ x = (a + b) / 2 and ∫ x xᵀ = (a aᵀ + b bᵀ) / 3 + (a bᵀ + b aᵀ) / 6, and its cross-section, w wide
and h high, adds w²/12 across and h²/12 upward.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


_PAIRS = ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))
COLUMNS = 1 + 3 + len(_PAIRS)


def moments_of(start: Float, end: Float, filament: Float, width: Float, height: Float) -> Float:
    """(n, 10) float64: filament, first moments (x, y, z), second (xx, yy, zz, xy, xz, yz).

    start, end : (n, 3) mm, axes of the beads;  filament : (n,) in any unit;  width, height : (n,)
    mm.
    """
    columns = [filament, *((filament / 2)[:, None] * (start + end)).T]
    along = end - start
    square = np.maximum(np.einsum("ij,ij->i", along[:, :2], along[:, :2]), 1e-24)
    across = np.stack([-along[:, 1], along[:, 0]]) / np.sqrt(square)
    for i, j in _PAIRS:
        a, b, c, d = start[:, i], end[:, i], start[:, j], end[:, j]
        second = (a * c + b * d) / 3 + (a * d + b * c) / 6
        if i < 2 and j < 2:
            second = second + width**2 / 12 * across[i] * across[j]
        elif i == j:
            second = second + height**2 / 12
        columns.append(filament * second)
    return np.stack(columns, axis=1)


def sums_by(group: Int, values: Float, groups: int) -> Float:
    """(groups, k) sums of the rows of values (n, k) by group (n,)."""
    columns = [np.bincount(group, column, minlength=groups) for column in values.T]
    return np.stack(columns, axis=1)


def inertia_about_centre(moments: Float) -> Float:
    """(3, 3) inertia tensor about the centre of mass, from moments (10,)."""
    mass, first, second = moments[0], moments[1:4], moments[4:]
    scatter = np.zeros((3, 3))
    for (i, j), value in zip(_PAIRS, second, strict=True):
        scatter[i, j] = scatter[j, i] = value - first[i] * first[j] / mass
    inertia: Float = np.trace(scatter) * np.eye(3) - scatter
    return inertia
