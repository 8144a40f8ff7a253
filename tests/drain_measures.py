"""Measures of drains on a final mesh, by slicing it across them."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold
from numpy.typing import NDArray

from printprep.types import Drain


def across(part: Manifold, drain: Drain) -> Manifold:
    """The part with the drain's axis as z, its mouth's middle the origin, outward upward."""
    axis = np.array(drain.axis)
    aside = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(aside, axis)
    first /= np.linalg.norm(first)
    frame = np.stack([first, np.cross(axis, first), axis])
    return part.transform(np.column_stack([frame, -frame @ np.array(drain.centre_mm)]))


def hole_diameter_mm(part: Manifold, drain: Drain) -> float:
    """Twice the distance of the material from the drain's axis, the least of eight sections.

    Where a thin wall leans, no section has the material all around the axis; its nearest is as far.
    """
    turned = across(part, drain)
    widths = []
    for depth in np.linspace(0.25, 0.75, 8) * drain.length_mm:
        contours = [np.asarray(p) for p in turned.slice(-depth).to_polygons()]
        widths += [2 * _distance_to_origin(contour) for contour in contours]
    return float(min(widths))


def _distance_to_origin(polygon: NDArray[np.float64]) -> float:
    a, b = polygon, np.roll(polygon, -1, axis=0)
    way = b - a
    length = (way**2).sum(axis=1)
    share = np.clip(-(a * way).sum(axis=1) / np.maximum(length, 1e-30), 0, 1)
    return float(np.linalg.norm(a + share[:, None] * way, axis=1).min())
