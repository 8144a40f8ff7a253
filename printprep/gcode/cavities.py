"""Finds the beads that are printed inside cavities, which should stay empty."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs
from printprep.mesh.measure import arrays, distance_to_mesh_mm, winding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int


_STEP_MM = 0.5
_SAMPLES_MAX = 4096  # of one stretch: finer than a millimetre on any bed
_POINTS_MAX = 1 << 20


class Cavities:
    """Closed solids that should stay empty, in the coordinates of the G-code."""

    def __init__(self, solids: Sequence[Manifold]) -> None:
        self._meshes = [arrays(solid) for solid in solids]
        self._boxes = [(mesh[0].min(axis=0), mesh[0].max(axis=0)) for mesh in self._meshes]

    def share_inside(self, start: Float, end: Float, deeper_mm: Float) -> Float:
        """(n,) share of each stretch whose axis lies deeper than ``deeper_mm`` in a cavity.

        start, end : (n, 3) mm;  deeper_mm : (n,).  Sampled every 0.5 mm.
        """
        share = np.zeros(len(start))
        low, high = np.minimum(start, end), np.maximum(start, end)
        for (vertices, faces), (bottom, top) in zip(self._meshes, self._boxes, strict=True):
            near = np.flatnonzero(((high > bottom) & (low < top)).all(axis=1))
            length = np.linalg.norm(end[near] - start[near], axis=1)
            samples = np.clip(np.ceil(length / _STEP_MM), 1, _SAMPLES_MAX).astype(np.int64)
            # In parts, so that memory stays bounded for any file.
            parts = np.flatnonzero(np.diff(np.cumsum(samples) // _POINTS_MAX, prepend=0))
            for some, counts in zip(np.split(near, parts), np.split(samples, parts), strict=True):
                owner, step = runs(counts)
                at = ((step + 0.5) / counts[owner])[:, None]
                points = start[some][owner] * (1 - at) + end[some][owner] * at
                within = _deeper(points, deeper_mm[some][owner], vertices, faces, bottom, top)
                share[some] += np.bincount(owner, within, minlength=len(some)) / counts
        return share


def _deeper(
    points: Float, deeper: Float, vertices: Float, faces: Int, bottom: Float, top: Float
) -> Bool:
    """(k,) whether points (k, 3) lie deeper than ``deeper`` (k,) mm in a mesh.

    vertices : (n, 3) mm;  faces : (m, 3);  bottom, top : (3,) mm, corners of its bounding box.
    """
    margin = deeper[:, None]
    boxed = ((points > bottom + margin) & (points < top - margin)).all(axis=1)
    at = np.flatnonzero(boxed)
    at = at[winding(points[at], vertices, faces) > 0.5]
    inside = np.zeros(len(points), dtype=bool)
    inside[at] = distance_to_mesh_mm(points[at], vertices, faces) > deeper[at]
    return inside
