"""Where a triangle mesh passes through itself: edges that pierce triangles they do not belong to.

Two triangles that cross always have an edge of one through the other.  Surfaces that only touch,
at a corner or flat on each other, are not pierced.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.weld import components, directed_edges, opposite_edges

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

# Closer than this share of the size to an edge's end, it touches and does not pierce.
_TOUCH = 1e-5
# Nor does what an end lies this close beyond: slivers of a kernel's own tolerance reach so far.
_SHALLOW = 5e-5
# Faces that turn back more sharply than by this cosine may have been folded over; what they went
# through lies within so many rings of triangles.
_FOLDED = -0.85
_RINGS = 2
# An edge that first meets a triangle at its own corner is followed on, so many times.
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class SelfIntersections:
    """Edges through triangles.

    edge : (k, 2) vertex indices;  face : (k,) the triangle;  at_mm : (k, 3) where.
    apart : (k,) whether the two belong to different pieces of the surface.
    """

    edge: Int
    face: Int
    at_mm: Float
    apart: Bool


def self_intersections(vertices: Float, faces: Int) -> SelfIntersections:
    """The edges of a mesh that pierce it, each with the first triangle it goes through.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3).
    """
    surface = SurfaceTree(vertices, faces)
    edges = np.unique(np.sort(directed_edges(faces), axis=1), axis=0)
    way = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    length = np.linalg.norm(way, axis=1)
    touch = _TOUCH * float(np.ptp(vertices, axis=0).max())
    going = np.flatnonzero(length > 3 * touch)
    done = np.full(len(edges), touch)
    hit = np.full(len(edges), -1, dtype=np.int64)
    for _ in range(_ROUNDS):
        unit = way[going] / length[going, None]
        far, face = surface.first_hit(vertices[edges[going, 0]] + done[going, None] * unit, unit)
        done[going] += far
        inside = (face >= 0) & (done[going] < length[going] - touch)
        own = (faces[face][:, :, None] == edges[going][:, None, :]).any(axis=(1, 2))
        hit[going[inside & ~own]] = face[inside & ~own]
        going = going[inside & own]
        done[going] += touch
    found = np.flatnonzero(hit >= 0)
    found = found[_beyond(vertices, edges[found], faces[hit[found]]) > _SHALLOW / _TOUCH * touch]
    piece = np.zeros(len(vertices), dtype=np.int64)
    for number, group in enumerate(components(faces, len(vertices))):
        piece[faces[group]] = number
    at = vertices[edges[found, 0]] + (done[found] / length[found])[:, None] * way[found]
    return SelfIntersections(
        edge=edges[found],
        face=hit[found],
        at_mm=at,
        apart=piece[edges[found, 0]] != piece[faces[hit[found], 0]],
    )


def folded(vertices: Float, faces: Int) -> bool:
    """Whether a closed surface passes through itself beside an edge folded over.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3).  Simplifying a surface can do that.  Only the
    triangles around such edges are looked at: a small part of :func:`self_intersections`.
    """
    one, other = (rows // 3 for rows in opposite_edges(faces))
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1)
    back = np.einsum("ij,ij->i", normal[one], normal[other]) < _FOLDED * length[one] * length[other]
    if not back.any():
        return False
    near: Bool = np.zeros(len(faces), dtype=bool)
    near[one[back]] = near[other[back]] = True
    for _ in range(_RINGS):
        voxelize_surface = np.zeros(len(vertices), dtype=bool)
        voxelize_surface[faces[near]] = True
        near[:] = voxelize_surface[faces].any(axis=1)
    return len(self_intersections(vertices, faces[near]).face) > 0


def _beyond(vertices: Float, edges: Int, faces: Int) -> Float:
    """(k,) how far the nearer end of each edge lies from the plane of its triangle."""
    a, b, c = (vertices[faces[:, corner]] for corner in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(np.float64).tiny)[:, None]
    ends: Float = np.abs(np.einsum("ij,ikj->ik", normal, vertices[edges] - a[:, None]))
    nearer: Float = ends.min(axis=1)
    return nearer
