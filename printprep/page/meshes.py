"""The meshes that a page shows: coarse enough for a browser, every triangle in its layer."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.measure import area_normals, arrays, signed_volumes
from printprep.page.encode import ViewMesh
from printprep.thickness.local import local_thickness

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int
    from printprep.page.shape import Shape
    from printprep.types import Drain

MOST_TRIANGLES = 300_000
"""A part with more is simplified for the page."""
# Large triangles are divided, so that thickness has corners to be shown at.
_DIVIDED_TRIANGLES = 24_000
_LEAST_EDGE = 1 / 160  # of the largest extent
# Simplification starts with this share of the largest extent, and doubles.
_FIRST_TOLERANCE = 1 / 20_000
# A triangle lies on a surface that is this close to its middle, mm.
_ON_MM = 0.03
# Pieces of a solid with less volume are what rounding leaves.
_CRUMB_MM3 = 0.02
# Thickness is measured up to so many walls: a ball that is no larger stays near its surface, where
# few triangles are; in the middle of a round body all of them would be as near.
MOST_WALLS = 4.0
_SAMPLES = 30_000
_NEIGHBOURS = 4

PART_LAYERS = ("outside", "base", "cavity", "vaults", "ballast", "drains")


@dataclass(frozen=True, eq=False)
class Meshes:
    """The meshes of a page, the part first.

    triangles : of the part;  shown : of the part as the page shows it;  moved_mm : how far its
    surface moved at most.
    """

    meshes: tuple[ViewMesh, ...]
    triangles: int
    shown: int
    moved_mm: float


def meshes_of(shape: Shape, wall_mm: float, most: int = MOST_TRIANGLES) -> Meshes:
    """The meshes of a shape.

    wall_mm : the profile's wall; thickness is told up to MOST_WALLS times as much.
    """
    simple, moved_mm = simplified(shape.part, most)
    fine = _divided(simple, most)
    vertices, faces = arrays(fine)
    thickness = _thickness(shape.part, vertices, faces, MOST_WALLS * wall_mm)
    part = ViewMesh(
        "part",
        vertices,
        faces,
        _classes(shape, vertices, faces, _ON_MM + moved_mm + shape.slack_mm),
        PART_LAYERS,
        thickness,
    )
    solids = [
        ("base", shape.base),
        ("vaults", shape.vaults),
        ("ballast", shape.ballast),
        ("infill", shape.infill),
    ]
    others = [_solid(name, solid, most) for name, solid in solids if solid is not None]
    if shape.plugs:
        others.append(_several("plugs", shape.plugs))
    return Meshes((part, *others), shape.part.num_tri(), len(faces), moved_mm)


def simplified(solid: Manifold, most: int) -> tuple[Manifold, float]:
    """The solid with at most so many triangles, and how far its surface moved at most, mm."""
    if solid.num_tri() <= most:
        return solid, 0.0
    tolerance = _extent(solid) * _FIRST_TOLERANCE
    found = solid
    while found.num_tri() > most and tolerance < _extent(solid):
        found = solid.simplify(tolerance)
        moved, tolerance = tolerance, 2 * tolerance
    return found, moved


def _extent(solid: Manifold) -> float:
    box = solid.bounding_box()
    return max(float(box[axis + 3] - box[axis]) for axis in range(3))


def _divided(solid: Manifold, most: int) -> Manifold:
    """The solid with its large triangles divided; the surface stays where it is."""
    area = float(solid.surface_area())
    edge = max((area / _DIVIDED_TRIANGLES * 4 / np.sqrt(3)) ** 0.5, _extent(solid) * _LEAST_EDGE)
    fine = solid.refine_to_length(2 * edge)
    grown = fine.num_tri() - solid.num_tri()
    return fine if grown < 4 * _DIVIDED_TRIANGLES and fine.num_tri() <= most else solid


def _solid(name: str, solid: Manifold, most: int) -> ViewMesh:
    vertices, faces = _without_crumbs(*arrays(simplified(solid, most)[0]))
    return ViewMesh(name, vertices, faces, np.zeros(len(faces), dtype=np.int64), (name,))


def _without_crumbs(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """Vertices (n, 3) and faces (m, 3) without the small pieces that a difference leaves."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    joined = coo_matrix(
        (np.ones(len(faces) * 2), (faces[:, :2].ravel(), faces[:, 1:].ravel())),
        shape=(len(vertices), len(vertices)),
    )
    pieces, piece = connected_components(joined, directed=False)
    volume = np.zeros(pieces)
    np.add.at(volume, piece[faces[:, 0]], signed_volumes(vertices[faces] - vertices.mean(axis=0)))
    kept = faces[np.abs(volume[piece[faces[:, 0]]]) > _CRUMB_MM3]
    used, inverse = np.unique(kept, return_inverse=True)
    return vertices[used], inverse.reshape(-1, 3)


def _several(name: str, solids: tuple[Manifold, ...]) -> ViewMesh:
    """Solids that may touch as one mesh."""
    every = [arrays(solid) for solid in solids]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in every[:-1])])
    faces = np.concatenate([f + s for (_, f), s in zip(every, starts, strict=True)])
    vertices = np.concatenate([vertices for vertices, _ in every])
    return ViewMesh(name, vertices, faces, np.zeros(len(faces), dtype=np.int64), (name,))


def _classes(shape: Shape, vertices: Float, faces: Int, on_mm: float) -> Int:
    """(m,) index in PART_LAYERS of each triangle of the part; vertices (n, 3), faces (m, 3)."""
    classes = np.zeros(len(faces), dtype=np.int64)
    middles = vertices[faces].mean(axis=1)
    if shape.base is not None:
        classes[_on(shape.base, middles, on_mm)] = PART_LAYERS.index("base")
    if not shape.cavities:
        return classes
    inside = ~_on(shape.outside, middles, on_mm)
    if not inside.any():  # walls thinner than the tolerance do not exist
        return classes
    classes[inside] = PART_LAYERS.index("cavity")
    where = np.flatnonzero(inside)
    if shape.ballast is not None:
        on = _on(shape.ballast, middles[where], on_mm)
        classes[where[on]] = PART_LAYERS.index("ballast")
        where = where[~on]
    if shape.vaults is not None and shape.deep is not None:
        off = ~_on(shape.deep, middles[where], on_mm)
        classes[where[off]] = PART_LAYERS.index("vaults")
    for drain in shape.drains:
        classes[_in_bore(drain, middles) & inside] = PART_LAYERS.index("drains")
    return classes


def _on(solid: Manifold, places: Float, on_mm: float) -> Bool:
    """(k,) whether places (k, 3) lie on a solid's surface."""
    box = np.array(solid.bounding_box())
    near = ((places >= box[:3] - on_mm) & (places <= box[3:] + on_mm)).all(axis=1)
    found = np.zeros(len(places), dtype=bool)
    if near.any():
        found[near] = SurfaceTree(*arrays(solid)).nearest(places[near])[0] <= on_mm
    return found


def _in_bore(drain: Drain, middles: Float) -> Bool:
    """(m,) whether places (m, 3) lie on the wall of a drain's channel."""
    axis = np.array(drain.axis)
    away = middles - np.array(drain.centre_mm)
    along = away @ axis
    beside = np.linalg.norm(away - along[:, None] * axis, axis=1)
    radius = drain.diameter_mm / 2
    wall = (beside < 1.06 * radius) & (beside > 0.9 * radius)
    result: Bool = wall & (along < radius) & (along > -drain.length_mm - radius)
    return result


def _thickness(part: Manifold, vertices: Float, faces: Int, most_mm: float) -> Float:
    """(n,) mm, local thickness of the part at vertices (n, 3) of the mesh that the page shows, at
    most ``most_mm``.

    It is measured at samples of the part itself; a vertex takes the weighted mean of the nearest
    ones that face the same way.
    """
    from scipy.spatial import cKDTree

    found = local_thickness(*arrays(part), samples=_SAMPLES, at_most_mm=most_mm)
    tree = cKDTree(found.points)
    distance, index = tree.query(vertices, k=2 * _NEIGHBOURS)
    normals = _vertex_normals(vertices, faces)
    same = np.einsum("nki,ni->nk", found.normals[index], normals) > 0.35
    rank = np.cumsum(same, axis=1)
    weight = np.where(same & (rank <= _NEIGHBOURS), 1 / (distance + 1e-3), 0.0)
    total = weight.sum(axis=1)
    mean = (weight * found.ball_mm[index]).sum(axis=1)
    nearest = found.ball_mm[index[:, 0]]
    result: Float = np.where(total > 0, mean / np.where(total > 0, total, 1.0), nearest)
    return result


def _vertex_normals(vertices: Float, faces: Int) -> Float:
    """(n, 3) unit normals at vertices, the mean of their faces by area."""
    weighted = area_normals(vertices[faces])
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], weighted)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    result: Float = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    return result
