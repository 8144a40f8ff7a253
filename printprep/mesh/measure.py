"""What can be said about a manifold exactly: arrays, integrals, distances, shells.

Notation: a, b, c the corners of a triangle seen counter-clockwise from outside, r a reference
point; the signed tetrahedron (r, a, b, c) has volume V = det(a−r, b−r, c−r)/6.  Sums of such
tetrahedra over a closed surface are the integrals over what it encloses (the divergence theorem);
voids, being inverted shells, subtract themselves.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.types import MassProperties

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


# A shell's vertices are asked in which other shell they lie; so many, evenly spread over the list.
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
    if len(mesh.merge_from_vert):  # vertices split for their properties are one again
        joined = np.arange(len(vertices), dtype=np.int64)
        joined[np.asarray(mesh.merge_from_vert, dtype=np.int64)] = mesh.merge_to_vert
        used, index = np.unique(joined[faces], return_inverse=True)
        return vertices[used], index.reshape(-1, 3).astype(np.int64)
    return vertices, faces


def try_manifold(vertices: Float, faces: Int) -> tuple[Manifold, str]:
    """The manifold of a triangle mesh in float64, and its status by name ("NoError" is valid)."""
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
    GeometryError : the faces do not bound a solid; the message says in what way.
    """
    manifold, status = try_manifold(vertices, faces)
    if status != "NoError":
        fact = _STATUS.get(status, status)
        raise GeometryError(f"A mesh of {len(faces)} triangles bounds no solid: {fact}.")
    return manifold


def mass_properties(manifold: Manifold) -> MassProperties:
    """Volume, centre of mass and inertia about it, at unit density, exact up to rounding.

    Raises GeometryError when the volume is not positive: an empty solid has no centre.
    """
    vertices, faces = arrays(manifold)
    if len(vertices) == 0:
        raise GeometryError("An empty solid has no volume and no centre of mass.")
    # Measured from the middle of its own bounds, a part far from the origin loses no digits.
    reference = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    corners = (vertices - reference)[faces]
    volumes = signed_volumes(corners)
    volume = float(volumes.sum())
    if not volume > 0:
        raise GeometryError(f"A solid of volume {volume:g} mm³ has no centre of mass.")
    sums = corners.sum(axis=1)
    centre = (volumes[:, None] * sums).sum(axis=0) / (4 * volume)
    # ∫ x xᵀ over the tetrahedron (0, a, b, c) = V/20 · (a aᵀ + b bᵀ + c cᵀ + s sᵀ), s = a + b + c.
    second = np.einsum("f,fki,fkj->ij", volumes, corners, corners)
    second += np.einsum("f,fi,fj->ij", volumes, sums, sums)
    second = second / 20 - volume * np.outer(centre, centre)
    inertia = np.trace(second) * np.eye(3) - second
    xyz = [float(value) for value in centre + reference]
    rows = [[float(value) for value in row] for row in (inertia + inertia.T) / 2]
    return MassProperties(
        volume_mm3=volume,
        centre_mm=(xyz[0], xyz[1], xyz[2]),
        inertia_mm5=tuple((row[0], row[1], row[2]) for row in rows),
    )


def signed_volumes(corners: Float) -> Float:
    """(m,) signed volumes of the tetrahedra from the origin to triangles (m, 3 corners, 3 xyz)."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    result: Float = np.einsum("fi,fi->f", a, np.cross(b, c)) / 6
    return result


def winding(points: Float, vertices: Float, faces: Int) -> Float:
    """(n,) generalized winding number of points (n, 3) about a triangle mesh, closed or not.

    Jacobson et al., "Robust inside-outside segmentation using generalized winding numbers", 2013,
    by the far-field expansion of Barill et al., "Fast winding numbers for soups and clouds", 2018
    (error a few thousandths).  1 inside, 0 outside, 2 where two shells overlap, between where the
    surface is open.
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
    """(n,) unsigned exact distance of points (n, 3) mm to a triangle mesh, inf to an empty one."""
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
    """(n,) unsigned exact distance of points (n, 3) mm to the surface, voids included."""
    return distance_to_mesh_mm(points, *arrays(manifold))


def inverted(manifold: Manifold) -> Manifold:
    """The same surface seen from the other side: a solid becomes a void, a void a solid."""
    vertices, faces = arrays(manifold)
    return from_arrays(vertices, faces[:, ::-1])


def shells(manifold: Manifold) -> tuple[tuple[Manifold, ...], tuple[Manifold, ...]]:
    """Its closed surfaces: those that bound material from outside, and its voids.

    Both as solids of positive volume: the voids come turned inside out.
    """
    parts = manifold.decompose()
    solids = tuple(part for part in parts if part.volume() >= 0)
    voids = tuple(inverted(part) for part in parts if part.volume() < 0)
    return solids, voids


def bodies(manifold: Manifold) -> tuple[Manifold, ...]:
    """The disjoint bodies, each with the voids inside it, in the order of ``decompose``."""
    solids, voids = shells(manifold)
    owned: list[list[Manifold]] = [[solid] for solid in solids]
    for void in voids:
        owner = innermost(void, solids)
        if owner is not None:
            owned[owner].append(inverted(void))
    return tuple(together(group) if len(group) > 1 else group[0] for group in owned)


def together(shells: Sequence[Manifold]) -> Manifold:
    """Disjoint shells as one manifold, each as it is: voids stay voids.

    (manifold3d's ``compose`` unites instead, and a void united with its solid is gone.)
    """
    every = [arrays(shell) for shell in shells]
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in every[:-1])])
    return from_arrays(
        np.concatenate([vertices for vertices, _ in every]),
        np.concatenate([faces + start for (_, faces), start in zip(every, starts, strict=True)]),
    )


def innermost(shell: Manifold, solids: Sequence[Manifold]) -> int | None:
    """Index of the smallest solid that contains most of the shell's vertices, None if none does."""
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


def _boxes_meet(a: Sequence[float], b: Sequence[float]) -> bool:
    return all(a[i] <= b[i + 3] and b[i] <= a[i + 3] for i in range(3))
