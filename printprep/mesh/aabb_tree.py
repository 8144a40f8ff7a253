"""A surface kept ready for many questions: what is nearest, and what a ray meets first."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


class SurfaceTree:
    """The triangles of a mesh in a search tree, built once.

    vertices, faces : (n, 3) mm and (m, 3).
    """

    def __init__(self, vertices: Float, faces: Int) -> None:
        import igl

        self._vertices = np.ascontiguousarray(vertices, dtype=np.float64)
        self._faces = np.ascontiguousarray(faces, dtype=np.int64)
        self._tree: Any = igl.AABB()
        self._tree.init(self._vertices, self._faces)
        # A ray that starts on the surface starts so far beyond it.
        self._beyond_mm = 1e-6 * float(np.ptp(vertices, axis=0).max())

    def nearest(self, points: Float) -> tuple[Float, Float]:
        """(n,) exact distances of points (n, 3) mm, and (n, 3) the nearest points of the mesh."""
        if len(points) == 0:
            return np.zeros(0), np.zeros((0, 3))
        squared, _, there = self._tree.squared_distance(
            self._vertices, self._faces, np.ascontiguousarray(points)
        )
        return np.sqrt(np.maximum(np.ravel(squared), 0.0)), np.reshape(there, (-1, 3))

    def first_hit(self, points: Float, ways: Float) -> tuple[Float, Int]:
        """(n,) how far a ray from each point (n, 3) along a unit vector (n, 3) goes, and the face.

        inf and −1 for rays that meet nothing.  Rays may start on the surface: what lies at the
        start itself is not met.
        """
        if len(points) == 0:
            return np.zeros(0), np.zeros(0, dtype=np.int64)
        starts = np.ascontiguousarray(points + self._beyond_mm * ways)
        face, along, _ = self._tree.intersect_ray_first(
            self._vertices, self._faces, starts, np.ascontiguousarray(ways)
        )
        face = np.ravel(face).astype(np.int64)
        return np.where(face >= 0, np.ravel(along) + self._beyond_mm, np.inf), face
