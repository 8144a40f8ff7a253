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
    """Twice the distance of the material from the drain's axis, where its wall is whole.

    Looked for at eight depths below the mouth's middle: the channel is round where the section is
    all around the axis, and there it must be one width.
    """
    turned = across(part, drain)
    widths = []
    for depth in np.linspace(0.25, 0.75, 8) * drain.length_mm:
        contours = [np.asarray(p) for p in turned.slice(-depth).to_polygons()]
        around = [contour for contour in contours if _winds_around_origin(contour)]
        holes = [contour for contour in around if _area(contour) < 0]
        if holes:
            widths.append(2 * min(_distance_to_origin(contour) for contour in holes))
    assert widths, "no whole wall around the drain"
    return float(min(widths))


def _winds_around_origin(polygon: NDArray[np.float64]) -> bool:
    angle = np.unwrap(np.arctan2(polygon[:, 1], polygon[:, 0]), period=2 * np.pi)
    first = np.arctan2(polygon[0, 1], polygon[0, 0])
    closing = (first - angle[-1] + np.pi) % (2 * np.pi) - np.pi
    return abs(angle[-1] + closing - angle[0]) > np.pi


def _area(polygon: NDArray[np.float64]) -> float:
    x, y = polygon.T
    return float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))) / 2


def _distance_to_origin(polygon: NDArray[np.float64]) -> float:
    a, b = polygon, np.roll(polygon, -1, axis=0)
    way = b - a
    length = (way**2).sum(axis=1)
    share = np.clip(-(a * way).sum(axis=1) / np.maximum(length, 1e-30), 0, 1)
    return float(np.linalg.norm(a + share[:, None] * way, axis=1).min())
