"""Finds the largest inscribed balls, by pattern search on an exact distance."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np

from printprep.arrays import Float

# The last step as a share of the first; it sets the accuracy of the depth.
LAST_STEP = 0.01
_STENCIL = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))


def deepest_points(
    depth_mm: Callable[[Float], Float], starts: Float, step_mm: float, enough_mm: float
) -> tuple[Float, Float]:
    """Climb from each start to a local maximum of a depth function, all at the same time.

    Parameters
    ----------
    depth_mm : points (n, 3) mm → depths (n,) mm, positive inside; each call asks for all points
        together, since it builds a search tree.
    starts : (k, 3) mm;  step_mm : first step, about the accuracy of the starts.
    enough_mm : a climb ends at this depth.

    Returns
    -------
    (k, 3) mm, points, and (k,) mm, depths: the radii of the balls inscribed there.
    """
    points = np.array(starts, dtype=float)
    best = depth_mm(points)
    steps = np.full(len(points), step_mm)
    while True:
        climbing = np.flatnonzero((steps > step_mm * LAST_STEP) & (best < enough_mm))
        if len(climbing) == 0:
            return points, best
        around = points[climbing, None] + steps[climbing, None, None] * _STENCIL
        values = depth_mm(around.reshape(-1, 3)).reshape(len(climbing), len(_STENCIL))
        top = values.argmax(axis=1)
        highest = values[np.arange(len(climbing)), top]
        better = highest > best[climbing] + 1e-12
        moved = climbing[better]
        points[moved] = around[better, top[better]]
        best[moved] = highest[better]
        steps[climbing[~better]] /= 2
