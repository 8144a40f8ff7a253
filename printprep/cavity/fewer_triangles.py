"""Fewer triangles for the cavity's surface, with its wall kept.

Marching cubes draws facets for every cell, most of them flat.  Merging flat ones and quadric edge
collapse (Garland and Heckbert, "Surface simplification using quadric error metrics", 1997) leave
a tenth of them or fewer, and move the surface by less than a tenth of a millimetre.  Where it then
lies too close to the outside, its corners move away from there by what is missing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.measure import area_normals, signed_volumes, try_manifold
from printprep.mesh.self_intersections import self_intersections
from printprep.mesh.weld import directed_edges

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

# A wall that is thinner than asked by more than the first is not accepted; then every place that
# is thinner by more than the second is corrected.  The promise is 0.05.
ACCEPTED_MM = 0.03
CORRECTED_MM = 0.02
# Where a facet is a chord, its wall may be thinner by this much on purpose.
CENTRED_MM = 0.015
MOST_CORRECTIONS = 6
# A surface that is farther off before correction has lost its shape.
LOST_MM = 0.2
# Least cosine between the normal of a facet and the way from the outside, where the facet is an
# offset of one surface.
ALONG = 0.9
# A surface that intersects itself returns there, each time in one ring of triangles more.
MOST_RETURNS = 3
# Where corners cannot be moved apart, the surface should lie so much deeper.
NECK_MM = 0.1
# Samples lie so many to a wall.
SAMPLES_PER_WALL = 2.0
# Nor do more lie along an edge: a long one is on a flat, and off by as much everywhere.
MOST_PIECES = 4


@dataclass(frozen=True, eq=False)
class Walls:
    """Samples of a cavity's surface, and the wall between each and the outside.

    face : (k,) the face that each lies on;  borne : (k, 3) the corners of the face that it moves
    with: one for a corner, two on an edge;  at_mm : (k, 3);  away : (k, 3) unit vector away from
    the outside;  missing_mm : (k,) how much thinner than asked the wall is, negative where it is
    thicker;  along : (k,) cosine between ``away`` and the inward normal of the face.
    """

    face: Int
    borne: Bool
    at_mm: Float
    away: Float
    missing_mm: Float
    along: Float

    @property
    def worst_mm(self) -> float:
        """The most that is missing anywhere."""
        return float(self.missing_mm.max(initial=0.0))


@dataclass(frozen=True, eq=False)
class Fewer:
    """What one try with a share of the triangles gives.

    solid : None where the surface cannot be corrected, or has lost its shape.
    necks_mm : (k, 3), where it cannot be corrected, since the outside is near on both sides;
    missing_mm : (k,) how much deeper the surface should lie there.  None of them where it has lost
    its shape: then it needs more triangles.
    """

    solid: Manifold | None
    necks_mm: Float
    missing_mm: Float


_NOWHERE = np.zeros((0, 3))
_LOST = Fewer(None, _NOWHERE, np.zeros(0))


def with_fewer_triangles(
    vertices: Float,
    faces: Int,
    share: float,
    outside: SurfaceTree,
    wall_mm: float,
    least_mm3: float,
) -> Fewer:
    """A solid on the level set of the depth at the wall, with a share of its triangles.

    Where a solid is returned, it is nowhere closer to the outside than the wall less 0.03 mm at its
    corners and at points at most half a wall apart on its edges and facets, nor are the corners of
    the outside to it.  It does not intersect itself.

    vertices : (n, 3) mm, faces : (m, 3), the level set;  least_mm3 : the least volume.
    """
    drawn, triangles = _decimated(vertices, faces, share)
    walls = measured(drawn, triangles, outside, wall_mm)
    if walls.worst_mm > LOST_MM:
        return _LOST if share < 1 else _uncorrected(walls)
    points = drawn + _moves(len(drawn), triangles, walls, raised=True)
    if _volume_mm3(points, triangles) < least_mm3:
        return _LOST  # every further move takes some more
    moved = np.flatnonzero((points != drawn).any(axis=1))
    walls = measured(points, triangles, outside, wall_mm, _around(moved, triangles))
    points, walls = _corrected(points, triangles, outside, wall_mm, walls)
    crossed = self_intersections(points, triangles)
    for rings in range(MOST_RETURNS):
        if not len(crossed.face):
            break
        # Around there the surface returns to where it was drawn
        back = np.union1d(crossed.edge, triangles[crossed.face])
        for _ in range(rings):
            back = np.unique(triangles[_around(back, triangles)])
        points[back] = drawn[back]
        walls = measured(points, triangles, outside, wall_mm, _around(back, triangles))
        points, walls = _corrected(points, triangles, outside, wall_mm, walls)
        crossed = self_intersections(points, triangles)
        walls = measured(points, triangles, outside, wall_mm)
    if walls.worst_mm > ACCEPTED_MM or len(crossed.face):
        return _uncorrected(walls, crossed.at_mm)
    solid, status = try_manifold(points, triangles)
    if status != "NoError" or solid.volume() < least_mm3:
        return _LOST
    return replace(_LOST, solid=solid)


def _uncorrected(walls: Walls, crossed_mm: Float = _NOWHERE) -> Fewer:
    """No solid, and where the surface should lie deeper.

    crossed_mm : (k, 3), where it intersects itself.
    """
    thin = walls.missing_mm > CORRECTED_MM
    return Fewer(
        None,
        np.concatenate([walls.at_mm[thin], crossed_mm]),
        np.append(walls.missing_mm[thin], np.full(len(crossed_mm), NECK_MM)),
    )


def _corrected(
    points: Float, faces: Int, outside: SurfaceTree, wall_mm: float, walls: Walls
) -> tuple[Float, Walls]:
    """(n, 3) mm, corners moved until no wall is too thin; and the walls of what moved last."""
    for _ in range(MOST_CORRECTIONS):
        if walls.worst_mm <= ACCEPTED_MM:
            break
        moves = _moves(len(points), faces, walls, raised=False)
        points = points + moves
        moved = np.flatnonzero(moves.any(axis=1))
        walls = measured(points, faces, outside, wall_mm, _around(moved, faces))
    return points, walls


def _volume_mm3(points: Float, faces: Int) -> float:
    """Volume of a closed surface: points (n, 3) mm, faces (m, 3)."""
    return float(signed_volumes((points - points.mean(axis=0))[faces]).sum())


def _around(corners: Int, faces: Int) -> Int:
    """(k,) the faces (m, 3) that have one of some corners."""
    return np.flatnonzero(np.isin(faces, corners).any(axis=1))


def _decimated(vertices: Float, faces: Int, share: float) -> tuple[Float, Int]:
    """The surface with a share of its triangles."""
    if share == 1:
        return vertices, faces
    from fast_simplification import simplify

    fewer_vertices, fewer_faces = simplify(
        np.require(vertices, np.float64, ["C", "W"]),  # it takes no read-only arrays
        faces.astype(np.int32),
        target_count=int(share * len(faces)),
    )
    return fewer_vertices.astype(np.float64), fewer_faces.astype(np.int64)


def measured(
    vertices: Float, faces: Int, outside: SurfaceTree, wall_mm: float, some: Int | None = None
) -> Walls:
    """The walls between a surface and the outside, at all faces (m, 3) or at some of them (k,)."""
    which = np.arange(len(faces)) if some is None else some
    points, face, borne = _samples(vertices, faces[which], wall_mm / SAMPLES_PER_WALL)
    distance, nearest, hit = outside.nearest_faces(points)
    # Only corners of the outside that are near the surface count: those of faces that were hit.
    corners = outside.vertices[np.unique(outside.faces[np.unique(hit)])]
    back, places, face_back = SurfaceTree(vertices, faces).nearest_faces(corners)
    at = np.concatenate([points, places])
    face = np.concatenate([which[face], face_back])
    away = _unit(at - np.concatenate([nearest, corners]))
    normals = _unit(area_normals(vertices[faces]))
    return Walls(
        face=face,
        borne=np.concatenate([borne, np.ones((len(places), 3), dtype=bool)]),
        at_mm=at,
        away=away,
        missing_mm=wall_mm - np.concatenate([distance, back]),
        along=-np.einsum("ij,ij->i", away, normals[face]),
    )


def _unit(vectors: Float) -> Float:
    """(k, 3) vectors of length 1, or 0 where there is no direction."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    unit: Float = vectors / np.maximum(length, np.finfo(np.float64).tiny)
    return unit


def _samples(vertices: Float, faces: Int, spacing_mm: float) -> tuple[Float, Int, Bool]:
    """Points on a surface at most a spacing apart: corners, and points on edges and inside facets.

    Returns (k, 3) mm, (k,) a face that each lies on, and (k, 3) the corners of that face that it
    lies between.
    """
    one, two = np.eye(3, dtype=bool), ~np.eye(3, dtype=bool)[[2, 0, 1]]
    corner, at = np.unique(faces, return_index=True)
    points, face, borne = [vertices[corner]], [at // 3], [one[at % 3]]

    edges = np.sort(directed_edges(faces), axis=1)
    _, at = np.unique(edges[:, 0] * len(vertices) + edges[:, 1], return_index=True)
    ends = vertices[edges[at]]
    pieces = _pieces(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1), spacing_mm)
    for count in np.unique(pieces):
        some = pieces == count
        for step in range(1, count):
            points.append(ends[some, 0] + (ends[some, 1] - ends[some, 0]) * (step / count))
            face.append(at[some] // 3)
            borne.append(two[at[some] % 3])

    corners = vertices[faces]
    longest = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max(axis=1)
    pieces = _pieces(longest, spacing_mm)
    for count in np.unique(pieces):
        some = np.flatnonzero(pieces == count)
        for weights in _inner_weights(int(count)):
            points.append(np.einsum("j,njk->nk", weights, corners[some]))
            face.append(some)
            borne.append(np.ones((len(some), 3), dtype=bool))
    return np.concatenate(points), np.concatenate(face), np.concatenate(borne)


def _pieces(length_mm: Float, spacing_mm: float) -> Int:
    """(n,) into how many pieces lengths (n,) are cut; at least 2, so that a middle is tried."""
    return np.clip(np.ceil(length_mm / spacing_mm), 2, MOST_PIECES).astype(np.int64)


def _inner_weights(count: int) -> Float:
    """(k, 3) barycentric coordinates of the points of a lattice strictly inside a triangle.

    With two pieces to an edge there is none of these, and the centre stands for them.
    """
    if count == 2:
        return np.full((1, 3), 1 / 3)
    a, b = np.meshgrid(np.arange(1, count), np.arange(1, count), indexing="ij")
    inside = a + b < count
    first, second = a[inside] / count, b[inside] / count
    return np.column_stack([first, second, 1 - first - second])


def _moves(count: int, faces: Int, walls: Walls, *, raised: bool) -> Float:
    """(count, 3) mm, for each corner what moves the thinnest wall it bears to where it belongs.

    On a flat that is the wall as asked.  A chord of a curved surface is too thick in its middle, or
    too thin at its ends: it is set on the level set on average, as far as that is allowed.

    raised : whether corners also move toward the outside, where walls are thicker than asked.
    """
    corners = faces[walls.face]
    smooth = (walls.along > ALONG) & (np.abs(walls.missing_mm) < LOST_MM)
    thickest = np.full(count, np.inf)
    bears = smooth[:, None] & walls.borne
    np.minimum.at(thickest, corners[bears], np.repeat(walls.missing_mm, bears.sum(axis=1)))
    order = np.argsort(walls.missing_mm, kind="stable")
    last = np.full(count, -1)
    # The thinnest is written last and stays
    last[corners[order][walls.borne[order]]] = np.repeat(order, walls.borne[order].sum(axis=1))
    used = np.flatnonzero(last >= 0)
    thinnest = last[used]
    thin = walls.missing_mm[thinnest] > CORRECTED_MM
    some = thin | smooth[thinnest] if raised else thin
    used, thinnest = used[some], thinnest[some]
    missing = walls.missing_mm[thinnest]
    spread = np.maximum(missing - np.minimum(thickest[used], missing), 0.0)
    moves = np.zeros((count, 3))
    off_mm = missing - np.minimum(spread / 2, CENTRED_MM)
    moves[used] = walls.away[thinnest] * off_mm[:, None]
    return moves
