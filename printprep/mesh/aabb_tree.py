"""A mesh in a search tree (axis-aligned boxes): nearest points, and first hits of rays."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


class SurfaceTree:
    """The triangles of a mesh in a search tree, which is built once."""

    def __init__(self, vertices: Float, faces: Int) -> None:
        """vertices : (n, 3) mm;  faces : (m, 3)."""
        import igl

        self.vertices = np.ascontiguousarray(vertices, dtype=np.float64)
        self.faces = np.ascontiguousarray(faces, dtype=np.int64)
        self._tree: Any = igl.AABB()
        self._tree.init(self.vertices, self.faces)
        # A ray that starts on the surface is moved forward by this much.
        self._beyond_mm = 1e-6 * float(np.ptp(vertices, axis=0).max())

    def nearest(self, points: Float) -> tuple[Float, Float]:
        """(k,) exact distances of points (k, 3) mm, and (k, 3) the nearest points of the mesh."""
        distance, closest, _ = self.nearest_faces(points)
        return distance, closest

    def nearest_faces(self, points: Float) -> tuple[Float, Float, Int]:
        """The same, and (k,) the face that the nearest point lies on."""
        if len(points) == 0:
            return np.zeros(0), np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
        squared, face, closest = self._tree.squared_distance(
            self.vertices, self.faces, np.ascontiguousarray(points)
        )
        distance = np.sqrt(np.maximum(np.ravel(squared), 0.0))
        return distance, np.reshape(closest, (-1, 3)), np.ravel(face).astype(np.int64)

    def first_hit(self, points: Float, directions: Float) -> tuple[Float, Int]:
        """(k,) mm to the first hit of each ray, and (k,) the face that it hits.

        points : (k, 3) mm, starts of the rays;  directions : (k, 3) unit vectors.  A ray without a
        hit gets inf and −1.  A ray may start on the surface: the place it starts from is no hit.
        """
        if len(points) == 0:
            return np.zeros(0), np.zeros(0, dtype=np.int64)
        starts = np.ascontiguousarray(points + self._beyond_mm * directions)
        face, along, _ = self._tree.intersect_ray_first(
            self.vertices, self.faces, starts, np.ascontiguousarray(directions)
        )
        face = np.ravel(face).astype(np.int64)
        return np.where(face >= 0, np.ravel(along) + self._beyond_mm, np.inf), face
