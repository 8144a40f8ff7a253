"""Find the voxels that a surface passes through, exactly, by separating axes.

Two convex bodies are apart exactly when an axis among their faces' normals and the cross products
of their edges separates them; for a triangle and a cube these are 13 axes (Akenine-Möller, "Fast 3D
triangle-box overlap testing", 2001).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from printprep.arrays import Float, Int

_PAIRS = 400_000  # of a triangle and a voxel, tested together


def voxelize_surface(corners: Float, resolution: int) -> NDArray[np.bool_]:
    """(N, N, N) bool: the voxels that triangles pass through or touch.

    corners : (m, 3, 3) triangles in voxels: voxel (i, j, k) is [i, i+1] × [j, j+1] × [k, k+1].
        Triangles outside the grid do not count.
    """
    found = np.zeros((resolution,) * 3, dtype=bool)
    low = np.floor(corners.min(axis=1)).astype(np.int64).clip(0)
    high = np.floor(corners.max(axis=1)).astype(np.int64).clip(max=resolution - 1)
    span = (high - low + 1).clip(0)
    for triangle, voxel in _candidates(low, span):
        # The triangles' boxes and the voxels overlap: that settles three of the axes.
        about = corners[triangle] - (voxel[:, None] + 0.5)
        meets = _meets(about)
        found[tuple(voxel[meets].T)] = True
    return found


def _candidates(low: Int, span: Int) -> Iterator[tuple[Int, Int]]:
    """(n,) triangles and (n, 3) voxels of their boxes, in chunks.

    low : (m, 3) lowest voxel of each triangle's box;  span : (m, 3) voxels along each axis.
    """
    count = span.prod(axis=1)
    until = np.cumsum(count)
    begin = 0
    while begin < len(count):
        done = until[begin - 1] if begin else 0
        end = max(int(np.searchsorted(until, done + _PAIRS, side="right")), begin + 1)
        owner = np.repeat(np.arange(begin, end), count[begin:end])
        offset = np.arange(len(owner)) - (until[owner] - count[owner] - done)
        _, wide, high = span[owner].T
        within = np.column_stack([offset // (wide * high), offset // high % wide, offset % high])
        yield owner, low[owner] + within
        begin = end


def _meets(about: Float) -> NDArray[np.bool_]:
    """(n,) bool, whether triangles (n, 3, 3) meet the cube of edge 1 about the origin."""
    edges = np.roll(about, -1, axis=1) - about
    normal = np.cross(edges[:, 0], edges[:, 1])
    height = np.abs(np.einsum("ni,ni->n", normal, about[:, 0]))
    meets: NDArray[np.bool_] = height <= 0.5 * np.abs(normal).sum(axis=1)
    left = np.flatnonzero(meets)
    for edge in range(3):
        for unit in np.eye(3):
            axis = np.cross(unit, edges[left, edge])
            along = np.einsum("nki,ni->nk", about[left], axis)
            reach = 0.5 * np.abs(axis).sum(axis=1)
            kept = (along.min(axis=1) <= reach) & (along.max(axis=1) >= -reach)
            meets[left[~kept]] = False
            left = left[kept]
    return meets
