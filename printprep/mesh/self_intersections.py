"""Finds where a mesh intersects itself: edges that pass through triangles not their own.

Where two triangles cross, an edge of one always passes through the other.  Surfaces that only
touch, at a corner or flat on each other, do not intersect.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import stable_order, unique_keys
from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.measure import area_normals
from printprep.mesh.weld import components, directed_edges, opposite_edges

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

# A hit this close to an end of the edge, as a share of the mesh's size, only touches.
_TOUCH = 1e-5
# So does an edge that ends this close beyond the triangle, or meets one that is this thin: slivers
# reach as far, by the tolerance of the boolean kernel.
_SHALLOW = 5e-5
# Neighbouring faces whose normals have a smaller cosine than this may be folded over; they
# intersect faces at most this many rings of triangles away.
_FOLDED = -0.85
_RINGS = 2
# Shorter sums of the unit normals beside an edge have no direction: the faces lie on each other.
_FLAT = 0.1
# After a hit on a triangle that shares a corner with the edge the ray goes on, this many times.
_ROUNDS = 3
# So many edges are cast as rays at once, to bound the memory.
_BLOCK = 1 << 18


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


_NONE = SelfIntersections(
    np.zeros((0, 2), dtype=np.int64),
    np.zeros(0, dtype=np.int64),
    np.zeros((0, 3)),
    np.zeros(0, dtype=bool),
)


def self_intersections(vertices: Float, faces: Int) -> SelfIntersections:
    """The edges of a mesh that pass through it, each with the first triangle on its way.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3).
    """
    surface = tree_of(vertices, faces)
    edges, first, same = _edges(faces, len(vertices))
    along = vertices[edges[:, 1]] - vertices[edges[:, 0]]
    length = np.linalg.norm(along, axis=1)
    touch = _TOUCH * float(np.ptp(vertices, axis=0).max())
    going = np.flatnonzero(length > 3 * touch)
    away = touch * _away(vertices, faces, first, same)
    met = np.zeros(len(edges), dtype=bool)
    for begin in range(0, len(going), _BLOCK):
        some = going[begin : begin + _BLOCK]
        unit, starts = along[some] / length[some, None], vertices[edges[some, 0]]
        for side in (away[some], -away[some]):
            met[some] |= surface.may_hit(starts + side, unit, length[some])
    going = going[met[going]]
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
    if not len(found):
        return _NONE
    at = vertices[edges[found, 0]] + (done[found] / length[found])[:, None] * along[found]
    least = _SHALLOW / _TOUCH * touch
    deep = _beyond(vertices, edges[found], faces[hit[found]]) > least
    deep &= _beyond(vertices, edges[found], _across(vertices, faces, hit[found], at, least)) > least
    deep &= _thickness(vertices[faces[hit[found]]]) > least
    found, at = found[deep], at[deep]
    if not len(found):
        return _NONE
    piece = np.zeros(len(vertices), dtype=np.int64)
    for number, group in enumerate(components(faces, len(vertices))):
        piece[faces[group]] = number
    return SelfIntersections(
        edge=edges[found],
        face=hit[found],
        at_mm=at,
        apart=piece[edges[found, 0]] != piece[faces[hit[found], 0]],
    )


def _edges(faces: Int, vertex_count: int) -> tuple[Int, Int, Int]:
    """(e, 2) the edges of faces (m, 3), (e,) the first directed edge of each, (3m,) which each is.

    The smaller vertex of an edge is first.
    """
    every = np.sort(directed_edges(faces), axis=1)
    first, same = unique_keys(every[:, 0] * vertex_count + every[:, 1])
    return every[first], first, same


def _away(vertices: Float, faces: Int, first: Int, same: Int) -> Float:
    """(e, 3) unit vectors from edges out of the planes of their faces.

    A line beside an edge, moved along this, meets none of its faces, but what the edge passes
    through.  first : (e,) the first directed edge of each;  same : (3m,) the edge of each directed
    edge.
    """
    normals = area_normals(vertices[faces])
    normals /= np.maximum(np.linalg.norm(normals, axis=1), np.finfo(np.float64).tiny)[:, None]
    away: Float = np.stack(
        [np.bincount(same, np.repeat(axis, 3), len(first)) for axis in normals.T],
        axis=1,
        dtype=np.float64,
    )
    length = np.linalg.norm(away, axis=1, keepdims=True)
    flat = length[:, 0] <= _FLAT
    away /= np.maximum(length, _FLAT)
    away[flat] = normals[first[flat] // 3]
    return away


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


def _across(vertices: Float, faces: Int, hit: Int, at: Float, rim_mm: float) -> Int:
    """(k, 3) the triangles hit, or where a hit is on the rim of one, the triangle across it.

    Rounding decides which of the two a ray hits: what is said of one has to hold for both.
    hit : (k,) faces;  at : (k, 3) mm, where.
    """
    result: Int = faces[hit].copy()
    edges = np.sort(directed_edges(faces), axis=1)
    keys = edges[:, 0] * len(vertices) + edges[:, 1]
    order = stable_order(keys)
    corners = vertices[result]
    for index in range(3):
        start, way = corners[:, index], corners[:, (index + 1) % 3] - corners[:, index]
        length = np.maximum(np.linalg.norm(way, axis=1), np.finfo(np.float64).tiny)
        rim = np.flatnonzero(np.linalg.norm(np.cross(at - start, way), axis=1) / length <= rim_mm)
        first = np.searchsorted(keys[order], keys[3 * hit[rim] + index])
        pair = order[np.minimum(first[:, None] + [0, 1], len(order) - 1)]  # the edge's two rows
        beside = np.where(pair[:, 0] // 3 == hit[rim], pair[:, 1], pair[:, 0])
        shared = keys[beside] == keys[3 * hit[rim] + index]
        result[rim[shared]] = faces[beside[shared] // 3]
    return result


def _thickness(corners: Float) -> Float:
    """(k,) mm, least height of triangles (k, 3 corners, 3 xyz)."""
    doubled = np.linalg.norm(area_normals(corners), axis=1)
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    result: Float = doubled / np.maximum(longest, np.finfo(np.float64).tiny)
    return result
