"""Turns triangles into pixels in numpy: a z-buffer without a graphics card, the same on every run.

Each triangle is tested at the pixels between its edges, row by row, in batches of bounded memory; a
pixel gets the nearest triangle over its centre, and the one with the lower index on a tie.

Source: the edge-function test of J. Pineda, "A parallel algorithm for polygon rasterization",
SIGGRAPH 1988.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

_BATCH_PIXELS = 1 << 20
_TRIFLE = 1e-6  # of a pixel


@dataclass(frozen=True, eq=False)
class Hits:
    """The triangle that each pixel shows; one entry for every pixel that shows one.

    pixel : (k,) row · size + column;  triangle : (k,) index;  weights : (k, 3) barycentric
    coordinates.
    """

    pixel: Int
    triangle: Int
    weights: Float


def rasterize(corners: Float, depth: Float, size: int) -> Hits:
    """The nearest triangle at every pixel of a `size` × `size` image.

    corners : (m, 3 corners, 2), x to the right and y down, in pixels, pixel centres at halves;
    depth : (m, 3), larger is nearer.
    """
    nearest = np.full(size * size, -np.inf)
    owner = np.full(size * size, len(corners), dtype=np.int64)
    for pixel, triangle, z in _candidates(corners, depth, size):
        closer = z >= nearest[pixel]
        pixel, triangle, z = pixel[closer], triangle[closer], z[closer]
        before = nearest.copy()
        np.maximum.at(nearest, pixel, z)
        owner[nearest > before] = len(corners)  # earlier owners lose it to a nearer triangle
        wins = z == nearest[pixel]
        np.minimum.at(owner, pixel[wins], triangle[wins])
    pixel = np.flatnonzero(owner < len(corners))
    triangle = owner[pixel]
    weights, _ = _weights(corners[triangle], *_centres(pixel % size, pixel // size))
    return Hits(pixel, triangle, weights)


def coverage(corners: Float, size: int) -> Bool:
    """(size, size) whether any triangle covers a pixel; arguments as for rasterize."""
    covered = np.zeros(size * size, dtype=bool)
    for pixel, _, _ in _candidates(corners, np.zeros(corners.shape[:2]), size):
        covered[pixel] = True
    return covered.reshape(size, size)


def _candidates(corners: Float, depth: Float, size: int) -> Iterator[tuple[Int, Int, Float]]:
    """Batches of pixel (k,), triangle (k,), depth (k,) for every pixel centre inside a triangle.

    corners : (m, 3, 2);  depth : (m, 3).
    """
    low = np.clip(np.ceil(corners[:, :, 1].min(axis=1) - 0.5), 0, size).astype(np.int64)
    high = np.clip(np.floor(corners[:, :, 1].max(axis=1) - 0.5) + 1, 0, size).astype(np.int64)
    owner, step = runs(np.maximum(high - low, 0))
    row = low[owner] + step
    first, last = _spans(corners[owner], row + 0.5, size)
    count = np.maximum(last + 1 - first, 0)
    some = np.flatnonzero(count)
    batch = np.cumsum(count[some]) // _BATCH_PIXELS
    for chosen in np.split(some, np.flatnonzero(np.diff(batch)) + 1):
        run, step = runs(count[chosen])
        span = chosen[run]
        triangle, column = owner[span], first[span] + step
        weights, inside = _weights(corners[triangle], *_centres(column, row[span]))
        weights, triangle = weights[inside], triangle[inside]
        z = (weights * depth[triangle]).sum(axis=1)
        yield (row[span] * size + column)[inside], triangle, z


def _spans(corners: Float, y: Float, size: int) -> tuple[Int, Int]:
    """(k,) first and (k,) last column of triangles (k, 3, 2) in the rows at heights y (k,).

    They are rounded outward, by a trifle more than the calculation is off.
    """
    left, right = np.full(len(y), -0.5), np.full(len(y), size + 0.5)
    x_low, x_high = corners[:, :, 0].min(axis=1), corners[:, :, 0].max(axis=1)
    area = _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for index in range(3):
        start, end = corners[:, index], corners[:, (index + 1) % 3]
        rise = end[:, 1] - start[:, 1]
        slanted = rise != 0
        meet = start[:, 0] + (end[:, 0] - start[:, 0]) * np.divide(
            y - start[:, 1], rise, out=np.zeros(len(y)), where=slanted
        )
        begins = slanted & ((rise > 0) != (area > 0))
        ends = slanted & ~begins
        left = np.where(begins, np.maximum(left, meet), left)
        right = np.where(ends, np.minimum(right, meet), right)
    left, right = np.maximum(left, x_low), np.minimum(right, x_high)
    first = np.clip(np.ceil(left - 0.5 - _TRIFLE), 0, size).astype(np.int64)
    last = np.clip(np.floor(right - 0.5 + _TRIFLE), -1, size - 1).astype(np.int64)
    return first, np.where(area == 0.0, first - 1, last)


def _cross(a: Float, b: Float) -> Float:
    """(k,) z component of the cross product of vectors (k, 2)."""
    result: Float = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    return result


def _centres(column: Int, row: Int) -> tuple[Float, Float]:
    return column.astype(np.float64) + 0.5, row.astype(np.float64) + 0.5


def _weights(corners: Float, x: Float, y: Float) -> tuple[Float, Bool]:
    """(k, 3) barycentric coordinates of points in triangles, and (k,) whether they lie inside.

    corners : (k, 3, 2);  x, y : (k,).  A point on an edge counts as inside; a triangle without area
    has no inside.
    """
    (ax, ay), (bx, by), (cx, cy) = (corners[:, index].T for index in range(3))
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    safe = np.where(area == 0.0, 1.0, area)
    u = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / safe
    v = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / safe
    weights = np.column_stack([u, v, 1.0 - u - v])
    return weights, (weights >= 0.0).all(axis=1) & (area != 0.0)
