"""The exact least distance between the surface of a solid and that of another one in it.

Notation: the distance is least between p on a face of the outside and c on the inside; L is the
longest edge of that face, and v its corner nearest to p, or where p lies on an edge the nearer end
of that edge.

Then c − p is at right angles to the face where p lies within it, and to the edge where p lies on
one, so |v − c|² = |p − c|² + |v − p|², and |v − p|² ≤ L²/3.  Only faces with a corner whose
distance d from the inside obeys d² ≤ |p − c|² + L²/3 can be nearest: of a fine mesh these are few.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.measure import area_normals, arrays, from_arrays

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

# Of outsides with more triangles, only those that can be nearest are measured, where these are at
# most this share of all.
MANY = 50_000
FEW_SHARE = 0.1
# They are measured as tetrahedra, this high toward the side that the inside is not on.
_HEIGHT_MM = 1e-6


def gap_mm(outside: Manifold, inside: Manifold, at_most_mm: float) -> float:
    """Least distance in mm between the surfaces of a solid and of another one in it.

    at_most_mm : a greater distance is reported as this.  It is 0 where one breaks through.
    """
    nearest = None
    if outside.num_tri() > MANY and not inside.is_empty():
        nearest = _few_that_can_be_nearest(*arrays(outside), inside, at_most_mm)
    if nearest is None:
        return float(_everything_beyond(outside).min_gap(inside, at_most_mm))
    if not (inside - outside).is_empty():
        return 0.0
    if not len(nearest):
        return at_most_mm
    return float(_thin_tetrahedra(nearest).min_gap(inside, at_most_mm))


def _everything_beyond(outside: Manifold) -> Manifold:
    """All space around a solid, up to its size away, as a solid: it has the same surface."""
    from manifold3d import Manifold

    low, high = np.reshape(outside.bounding_box(), (2, 3))
    margin = 1.0 + float((high - low).max())
    size, corner = (high - low + 2 * margin).tolist(), (low - margin).tolist()
    return Manifold.cube(size).translate(corner) - outside


def _few_that_can_be_nearest(
    vertices: Float, faces: Int, inside: Manifold, at_most_mm: float
) -> Float | None:
    """(k, 3 corners, 3 xyz) mm, triangles that may lie within a distance of the inside.

    vertices : (n, 3) mm;  faces : (m, 3).  None where they are not few.
    """
    distance, _ = tree_of(*arrays(inside)).nearest(vertices)
    a, b, c = (vertices[corner] for corner in faces.T)
    squares = [((p - q) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))]
    limit = at_most_mm**2 + np.maximum.reduce(squares) / 3
    near = np.minimum.reduce([distance[corner] for corner in faces.T]) ** 2 <= limit
    if int(near.sum()) > FEW_SHARE * len(faces):
        return None
    corners = vertices[faces[near]]
    # What has no area lies on the edges of others
    has_area = np.abs(area_normals(corners)).max(axis=1, initial=0.0) > 0
    some: Float = corners[has_area]
    return some


def _thin_tetrahedra(corners: Float) -> Manifold:
    """Triangles (k, 3 corners, 3 xyz), each as a tetrahedron that hardly rises above it."""
    normals = area_normals(corners)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    tip = corners.mean(axis=1) + _HEIGHT_MM * normals
    points = np.concatenate([corners, tip[:, None]], axis=1).reshape(-1, 3)
    sides = np.array([[2, 1, 0], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    faces = 4 * np.arange(len(corners))[:, None, None] + sides
    return from_arrays(points, faces.reshape(-1, 3))
