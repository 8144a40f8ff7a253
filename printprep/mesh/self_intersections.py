"""Finds where a mesh intersects itself: edges that pass through triangles not their own.

Where two triangles cross, an edge of one always passes through the other.  Surfaces that only
touch, at a corner or flat on each other, do not intersect.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.measure import area_normals
from printprep.mesh.weld import components, directed_edges, opposite_edges

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

# A hit this close to an end of the edge, as a share of the mesh's size, only touches.
_TOUCH = 1e-5
# So does an edge that ends this close beyond the triangle: slivers reach as far, by the tolerance
# of the boolean kernel.
_SHALLOW = 5e-5
# Neighbouring faces whose normals have a smaller cosine than this may be folded over; they
# intersect faces at most this many rings of triangles away.
_FOLDED = -0.85
_RINGS = 2
# Shorter sums of the unit normals beside an edge have no direction: the faces lie on each other.
_FLAT = 0.1
# After a hit on a triangle that shares a corner with the edge the ray goes on, this many times.
_ROUNDS = 3


@dataclass(frozen=True, eq=False)
class SelfIntersections:
    """Edges that pass through triangles.

    edge : (k, 2) vertex indices;  face : (k,) the triangle;  at_mm : (k, 3) the place;
    apart : (k,) whether the two belong to different pieces of the surface.
    """

    edge: Int
    face: Int
    at_mm: Float
    apart: Bool


def self_intersections(vertices: Float, faces: Int) -> SelfIntersections:
    """The edges of a mesh that pass through it, each with the first triangle on its way.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3).
    """
    surface = tree_of(vertices, faces)
    every = np.sort(directed_edges(faces), axis=1)
    _, first, same = np.unique(
        every[:, 0] * len(vertices) + every[:, 1], return_index=True, return_inverse=True
    )
    edges = every[first]
    along = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    length = np.linalg.norm(along, axis=1)
    touch = _TOUCH * float(np.ptp(vertices, axis=0).max())
    going = np.flatnonzero(length > 3 * touch)
    beside = vertices[edges[going, 0]] + touch * _away(vertices, faces, first, same)[going]
    unit = along[going] / length[going, None]
    going = going[surface.may_hit(beside, unit, length[going])]
    done = np.full(len(edges), touch)
    hit = np.full(len(edges), -1, dtype=np.int64)
    for _ in range(_ROUNDS):
        unit = along[going] / length[going, None]
        far, face = surface.first_hit_exactly(
            vertices[edges[going, 0]] + done[going, None] * unit, unit
        )
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
    at = vertices[edges[found, 0]] + (done[found] / length[found])[:, None] * along[found]
    return SelfIntersections(
        edge=edges[found],
        face=hit[found],
        at_mm=at,
        apart=piece[edges[found, 0]] != piece[faces[hit[found], 0]],
    )


def _away(vertices: Float, faces: Int, first: Int, same: Int) -> Float:
    """(e, 3) unit vectors from edges out of the planes of their faces.

    A line beside an edge, moved along this, meets none of its faces, but what the edge passes
    through.  first : (e,) the first directed edge of each;  same : (3m,) the edge of each directed
    edge.
    """
    normals = area_normals(vertices[faces])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(np.float64).tiny)[:, None]
    of_edge = np.repeat(normals, 3, axis=0)
    away = np.stack([np.bincount(same, axis, len(first)) for axis in of_edge.T], axis=1)
    length = np.linalg.norm(away, axis=1, keepdims=True)
    flat = length > _FLAT
    result: Float = np.where(flat, away / np.where(flat, length, 1.0), of_edge[first])
    return result


def folded(vertices: Float, faces: Int) -> bool:
    """Whether a closed surface intersects itself near an edge that is folded over.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3).  Simplification of a surface can cause this.
    Only the triangles around folded edges are tested: much less work than the whole mesh.
    """
    one, other = (rows // 3 for rows in opposite_edges(faces))
    normal = area_normals(vertices[faces])
    length = np.linalg.norm(normal, axis=1)
    back = np.einsum("ij,ij->i", normal[one], normal[other]) < _FOLDED * length[one] * length[other]
    if not back.any():
        return False
    near: Bool = np.zeros(len(faces), dtype=bool)
    near[one[back]] = near[other[back]] = True
    for _ in range(_RINGS):
        corners = np.zeros(len(vertices), dtype=bool)
        corners[faces[near]] = True
        near[:] = corners[faces].any(axis=1)
    return len(self_intersections(vertices, faces[near]).face) > 0


def _beyond(vertices: Float, edges: Int, faces: Int) -> Float:
    """(k,) mm, distance of the nearer end of each edge from the plane of its triangle.

    vertices : (n, 3) mm;  edges : (k, 2);  faces : (k, 3), the triangle of each edge.
    """
    corners = vertices[faces]
    normal = area_normals(corners)
    normal /= np.maximum(np.linalg.norm(normal, axis=1), np.finfo(np.float64).tiny)[:, None]
    ends: Float = np.abs(np.einsum("ij,ikj->ik", normal, vertices[edges] - corners[:, :1]))
    nearer: Float = ends.min(axis=1)
    return nearer
