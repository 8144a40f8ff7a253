"""Largest inscribed balls, by pattern search on an exact distance."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product

import numpy as np
from numpy.typing import NDArray

Float = NDArray[np.float64]

_STENCIL = np.array(list(product((-1.0, 0.0, 1.0), repeat=3)))


def deepest_point(
    depth_mm: Callable[[Float], Float], start: Float, step_mm: float, tolerance: float = 1e-3
) -> tuple[Float, float]:
    """Climb to a local maximum of a depth function.

    Parameters
    ----------
    depth_mm : (n, 3) points to (n,) depths; positive inside.
    start : (3,) mm;  step_mm : first step, about the accuracy of the start.
    tolerance : last step as a share of the first.

    Returns
    -------
    The point and its depth, which is the radius of the ball inscribed there.
    """
    point = np.asarray(start, dtype=float)
    best = float(depth_mm(point[None])[0])
    step = step_mm
    while step > step_mm * tolerance:
        around = point + step * _STENCIL
        values = depth_mm(around)
        top = int(np.argmax(values))
        if values[top] > best + 1e-12:
            point, best = around[top], float(values[top])
        else:
            step /= 2
    return point, best
