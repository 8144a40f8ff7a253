"""Exact measures of manifolds and meshes: arrays, integrals, distances, shells.

Notation: a, b, c the corners of a triangle seen counter-clockwise from outside, r a reference
point; the signed tetrahedron (r, a, b, c) has volume V = det(a−r, b−r, c−r)/6.  The sum of such
tetrahedra over a closed surface is the integral over the space it encloses (divergence theorem);
voids are inverted shells and so count negative.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.kept import kept
from printprep.types import MassProperties

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


# Vertices of a shell, evenly spread over its list, that decide in which other shell it lies.
_WITNESSES = 64

_STATUS = {
    "NotManifold": "the surface has open or doubled edges",
    "NonFiniteVertex": "some coordinates are not finite numbers",
    "VertexOutOfBounds": "a face refers to a vertex that does not exist",
    "ResultTooLarge": "the mesh is too large",
}


def arrays(manifold: Manifold) -> tuple[Float, Int]:
    """Vertices (n, 3) float64 mm and faces (m, 3) int64, counter-clockwise seen from outside."""
    mesh = manifold.to_mesh64()
    vertices = np.ascontiguousarray(mesh.vert_properties[:, :3], dtype=np.float64)
    faces = np.asarray(mesh.tri_verts).astype(np.int64)
    if len(mesh.merge_from_vert):  # join vertices that the kernel split for their properties
        joined = np.arange(len(vertices), dtype=np.int64)
        joined[np.asarray(mesh.merge_from_vert, dtype=np.int64)] = mesh.merge_to_vert
        used, index = np.unique(joined[faces], return_inverse=True)
        return vertices[used], index.reshape(-1, 3).astype(np.int64)
    return vertices, faces


def evaluate(manifolds: Iterable[Manifold]) -> None:
    """Let the kernel finish solids now, before several threads ask for them.

    It puts work off until it is asked, and does not expect to be asked twice at once.
    """
    for manifold in manifolds:
        manifold.num_tri()


def try_manifold(vertices: Float, faces: Int) -> tuple[Manifold, str]:
    """The manifold of vertices (n, 3) mm and faces (m, 3), and its status ("NoError" is valid)."""
    from manifold3d import Manifold, Mesh64

    mesh = Mesh64(
        # manifold3d's own arrays are read-only, and its constructor takes none that are.
        np.require(vertices, np.float64, ["C", "W"]),
        np.require(faces, np.uint64, ["C", "W"]),
    )
    manifold = Manifold(mesh)
    return manifold, str(manifold.status().name)


def from_arrays(vertices: Float, faces: Int) -> Manifold:
    """The manifold of vertices (n, 3) mm and faces (m, 3), in float64.

    Raises
    ------
    GeometryError : the faces do not bound a solid; the message says why.
    """
    manifold, status = try_manifold(vertices, faces)
    if status != "NoError":
        fact = _STATUS.get(status, status)
        raise GeometryError(f"A mesh of {len(faces)} triangles bounds no solid: {fact}.")
    return manifold


def mass_properties(manifold: Manifold) -> MassProperties:
    """Volume, centre of mass and inertia about it, at unit density, exact up to rounding.

    Raises GeometryError where the volume is not positive: there is no centre of mass then.
    """
    reference, corners = _about_middle(manifold)
    volumes, volume, centre = _first_moments(corners)
    # ∫ x xᵀ over the tetrahedron (0, a, b, c) = V/20 · (a aᵀ + b bᵀ + c cᵀ + s sᵀ), s = a + b + c.
    sums = corners.sum(axis=1)
    second = np.einsum("f,fki,fkj->ij", volumes, corners, corners)
    second += np.einsum("f,fi,fj->ij", volumes, sums, sums)
    second = second / 20 - volume * np.outer(centre, centre)
    inertia = np.trace(second) * np.eye(3) - second
    x, y, z = (centre + reference).tolist()
    rows = ((inertia + inertia.T) / 2).tolist()
    return MassProperties(
        volume_mm3=volume,
        centre_mm=(x, y, z),
        inertia_mm5=tuple((row[0], row[1], row[2]) for row in rows),
    )


def volume_and_centre(manifold: Manifold) -> tuple[float, tuple[float, float, float]]:
    """Volume in mm³ and centre of mass in mm: those of :func:`mass_properties`, without inertia.

    Raises GeometryError where the volume is not positive: there is no centre of mass then.
    """
    reference, corners = _about_middle(manifold)
    _, volume, centre = _first_moments(corners)
    x, y, z = (centre + reference).tolist()
    return volume, (x, y, z)


def _about_middle(manifold: Manifold) -> tuple[Float, Float]:
    """(3,) mm, the middle of the bounds, and (m, 3 corners, 3 xyz) the triangles about it.

    With it as reference a part far from the origin keeps all its digits.
    """
    vertices, faces = arrays(manifold)
    if len(vertices) == 0:
        raise GeometryError("An empty solid has no volume and no centre of mass.")
    reference: Float = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    return reference, (vertices - reference)[faces]


def _first_moments(corners: Float) -> tuple[Float, float, Float]:
    """(m,) signed volumes of triangles (m, 3, 3), their sum in mm³, and (3,) mm, the centre."""
    volumes = signed_volumes(corners)
    volume = float(volumes.sum())
    if not volume > 0:
        raise GeometryError(f"A solid of volume {volume:g} mm³ has no centre of mass.")
    sums = corners[:, 0] + corners[:, 1] + corners[:, 2]
    return volumes, volume, (volumes[:, None] * sums).sum(axis=0) / (4 * volume)


def signed_volumes(corners: Float) -> Float:
    """(m,) signed volumes of the tetrahedra from the origin to triangles (m, 3 corners, 3 xyz)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    result: Float = np.einsum("fi,fi->f", a, _cross(b, c)) / 6
    return result


def area_normals(corners: Float) -> Float:
    """(m, 3) outward normals of triangles (m, 3 corners, 3 xyz), as long as twice their area."""
    return _cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _cross(a: Float, b: Float) -> Float:
    """(m, 3) cross products of vectors (m, 3); like ``numpy.cross``, in half the time."""
    result = np.empty(a.shape)
    for x, y, z in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        result[:, x] = a[:, y] * b[:, z] - a[:, z] * b[:, y]
    return result


def winding(points: Float, vertices: Float, faces: Int) -> Float:
    """(k,) generalized winding number of points (k, 3) about a triangle mesh, closed or not.

    vertices : (n, 3) mm;  faces : (m, 3).  The number is 1 inside, 0 outside, 2 where two shells
    overlap, and between these near an opening of the surface.

    Jacobson et al., "Robust inside-outside segmentation using generalized winding numbers", 2013,
    by the far-field expansion of Barill et al., "Fast winding numbers for soups and clouds", 2018
    (error a few thousandths).
    """
    import igl

    if len(points) == 0 or len(faces) == 0:
        return np.zeros(len(points))
    result: Float = igl.fast_winding_number(
        np.ascontiguousarray(vertices, dtype=np.float64),
        np.ascontiguousarray(faces, dtype=np.int64),
        np.ascontiguousarray(points, dtype=np.float64),
    )
    return result


def distance_to_mesh_mm(points: Float, vertices: Float, faces: Int) -> Float:
    """(k,) mm, unsigned exact distance of points (k, 3) to a mesh, inf where it has no triangles.

    vertices : (n, 3) mm;  faces : (m, 3).
    """
    import igl

    if len(points) == 0 or len(faces) == 0:
        return np.full(len(points), np.inf)
    squared, _, _ = igl.point_mesh_squared_distance(
        np.ascontiguousarray(points, dtype=np.float64),
        np.ascontiguousarray(vertices, dtype=np.float64),
        np.ascontiguousarray(faces, dtype=np.int64),
    )
    result: Float = np.sqrt(np.maximum(squared, 0.0))
    return result


def distance_mm(points: Float, manifold: Manifold) -> Float:
    """(k,) mm, unsigned exact distance of points (k, 3) to the surface of a manifold, voids too."""
    return distance_to_mesh_mm(points, *arrays(manifold))


def inverted(manifold: Manifold) -> Manifold:
    """The same surface turned inside out: a solid becomes a void, a void a solid."""
    vertices, faces = arrays(manifold)
    return from_arrays(vertices, faces[:, ::-1])


@kept(most=1)
def shells(manifold: Manifold) -> tuple[tuple[Manifold, ...], tuple[Manifold, ...]]:
    """The shells of a manifold: those that bound material from outside, and the voids.

    All are returned as solids of positive volume: the voids are turned inside out.
    """
    parts = manifold.decompose()
    if len(parts) == 1 and parts[0].volume() >= 0:
        return (manifold,), ()  # the copy of a large solid takes as much memory again
    solids = tuple(part for part in parts if part.volume() >= 0)
    voids = tuple(inverted(part) for part in parts if part.volume() < 0)
    return solids, voids


def bodies(manifold: Manifold) -> tuple[Manifold, ...]:
    """The bodies that do not touch, each with its voids, in the order of ``decompose``."""
    solids, voids = shells(manifold)
    if len(solids) == 1 and all(_box_holds(solids[0], void) for void in voids):
        return (manifold,)
    owned: list[list[Manifold]] = [[solid] for solid in solids]
    for void in voids:
        owner = innermost(void, solids)
        if owner is not None:
            owned[owner].append(inverted(void))
    return tuple(together(group) if len(group) > 1 else group[0] for group in owned)


def together(shells: Sequence[Manifold]) -> Manifold:
    """Disjoint shells as one manifold; a void stays a void.

    (``compose`` of manifold3d unites them instead, and a void united with its solid disappears.)
    """
    every = [arrays(shell) for shell in shells]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in every[:-1])])
    return from_arrays(
        np.concatenate([vertices for vertices, _ in every]),
        np.concatenate([faces + start for (_, faces), start in zip(every, starts, strict=True)]),
    )


def innermost(shell: Manifold, solids: Sequence[Manifold]) -> int | None:
    """Index of the smallest solid that contains most vertices of the shell, None if none does."""
    vertices, _ = arrays(shell)
    witnesses = vertices[:: max(1, len(vertices) // _WITNESSES)]
    box = shell.bounding_box()
    best: int | None = None
    for index, solid in enumerate(solids):
        if not _boxes_meet(box, solid.bounding_box()):
            continue
        inside = winding(witnesses, *arrays(solid)) > 0.5
        smaller = best is None or solid.volume() < solids[best].volume()
        if smaller and 2 * int(inside.sum()) > len(witnesses):
            best = index
    return best


def _box_holds(solid: Manifold, void: Manifold) -> bool:
    a, b = solid.bounding_box(), void.bounding_box()
    return all(a[i] <= b[i] and b[i + 3] <= a[i + 3] for i in range(3))


def _boxes_meet(a: Sequence[float], b: Sequence[float]) -> bool:
    return all(a[i] <= b[i + 3] and b[i] <= a[i + 3] for i in range(3))
