"""Rounds coordinates to what files hold, and readers tell apart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float

# Within 16 mm of the origin single precision holds finer steps than this one.  Vertices that lie
# nearer to each other are one vertex to readers that weld within a tolerance (trimesh: 1e-8).
GRID_MM = 2.0**-20


def rounded(points: Float) -> Float:
    """(n, 3) mm, points (n, 3) on a grid of a millionth of a millimetre, in single precision."""
    on_grid = np.rint(points / GRID_MM) * GRID_MM
    result: Float = on_grid.astype(np.float32).astype(np.float64) + 0.0  # −0 becomes 0
    return result
