"""Points as findings carry them."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.arrays import Float


def mean_point(points: Float) -> tuple[float, float, float]:
    """The mean (x, y, z) of (k, 3) points, in the unit of the points."""
    x, y, z = points.mean(axis=0).tolist()
    return x, y, z
