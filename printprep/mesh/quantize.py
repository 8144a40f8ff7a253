"""Rounds a part to what a file holds: float32 coordinates, welded, still one clean manifold.

Files keep single precision (STL and PLY by their format, slicers after reading a 3MF), and readers
weld vertices that fall on one point.  Both can break a mesh that is sound in double precision.  So
the part is rounded first, and all checks and files start from the rounded part.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.kept import kept, read_only
from printprep.mesh.faithful import FOLDS, unfaithful
from printprep.mesh.measure import area_normals, arrays, from_arrays, together
from printprep.mesh.rounding import rounded
from printprep.mesh.weld import directed_edges, drop_collapsed, in_order, is_closed, unique_rows

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

# A shell with this mean thickness and this volume is the rest of a rounded sliver, not a feature.
_FLAT_SHELL_MM = 0.01
_FLAT_SHELL_MM3 = 0.5
# Surfaces that touch are moved apart by this much, several float32 steps at any printable size.
_APART_MM = 2e-4
# Tolerance of each attempt's simplification, none at first.
_MERGED_MM = (0.0, 2e-5, 5e-5, 1e-4, 2e-4, 4e-4)
# Rounds of moving apart at crowded edges alone.
_MOST_ROUNDS = 3
# The outside may move this much.
_MOVED_MM = 1e-3
_NUDGE = "A slightly different size (--size) usually avoids it."


def quantized(manifold: Manifold) -> Manifold:
    """The manifold whose welded vertices are exactly what a float32 file holds.

    Vertices move to multiples of 2⁻²⁰ mm, by at most half a float32 step (8e-6 mm at 200 mm); where
    two surfaces touch along an edge they move apart, by less than 0.001 mm.  Flat shells (mean
    thickness below 0.01 mm and volume below 0.5 mm³) are removed.  Applied to its own result it
    changes nothing.

    Each attempt is measured against the manifold that was given, and undone where it moved more.

    Raises GeometryError where no such form is found.
    """
    # What is not rounded yet is used here alone
    once = quantized_arrays if quantized_arrays.known(manifold) else _quantized_arrays
    vertices, faces = once(manifold)
    crowded = crowded_edges(faces)
    if not len(crowded):
        same = _is_rounded(manifold, len(vertices), len(faces))
        return _without_flat_shells(manifold if same else _rebuilt(vertices, faces))
    reason = "it still touches itself"
    near = _apart_at(manifold, vertices[np.unique(crowded)])
    if near is not None:
        return _without_flat_shells(near)
    apart, folds = manifold, None
    for tolerance_mm in _MERGED_MM:
        # Welding the ends of an edge shorter than a float32 step folds triangles over.
        apart = _moved_apart(apart.simplify(tolerance_mm) if tolerance_mm else apart)
        vertices, faces = _quantized_arrays(apart)
        if len(crowded_edges(faces)):
            continue
        found = _rebuilt(vertices, faces)
        fault = unfaithful(manifold, found, _MOVED_MM)
        if fault is None:
            return _without_flat_shells(found)
        if fault == FOLDS and folds is None:
            folds = found
        # What moved too far is no ground to go on from.
        reason, apart = fault, manifold
    if folds is not None:  # nothing else moved: the folds are narrower than the move
        return _without_flat_shells(folds)
    raise GeometryError(
        f"The part touches itself along an edge and cannot be moved apart there ({reason}).",
        _NUDGE,
    )


@kept(most=3)
def quantized_arrays(manifold: Manifold) -> tuple[Float, Int]:
    """Vertices rounded to float32 and welded, and the triangles that still have three corners.

    Returns (n, 3) float64 mm with float32 values, in lexicographic order, and (m, 3) int64,
    counter-clockwise seen from outside, each from its smallest index on, sorted: the same solid
    gives the same arrays, which are read-only.
    """
    found = _quantized_arrays(manifold)
    read_only(*found)
    return found


def _quantized_arrays(manifold: Manifold) -> tuple[Float, Int]:
    """Vertices (n, 3) mm and faces (m, 3), as :func:`quantized_arrays` gives them, anew."""
    points, corners = arrays(manifold)
    vertices, index = unique_rows(rounded(points))
    faces = drop_collapsed(index[corners])
    used = np.zeros(len(vertices), dtype=bool)
    used[faces] = True
    return vertices[used], in_order((np.cumsum(used) - 1)[faces])


def _is_rounded(manifold: Manifold, vertices: int, faces: int) -> bool:
    """Whether rounding, which leaves so many vertices and faces, changes nothing of a manifold."""
    if (manifold.num_vert(), manifold.num_tri()) != (vertices, faces):
        return False
    points, _ = arrays(manifold)
    return bool((rounded(points) == points).all())


def crowded_edges(faces: Int) -> Int:
    """(k, 2) directed edges of faces (m, 3) that do not occur once with exactly one opposite."""
    if is_closed(faces, once=True):
        return np.zeros((0, 2), dtype=np.int64)
    size = int(faces.max()) + 1
    start, end = directed_edges(faces).T
    there, back = np.sort(start * size + end), np.sort(end * size + start)
    repeated = there[1:][there[1:] == there[:-1]]
    # There and back are the same numbers where each edge has an opposite
    place = np.minimum(np.searchsorted(there, back), len(there) - 1)
    last, first = np.divmod(back[there[place] != back], size)
    keys = np.unique(np.concatenate([repeated, first * size + last]))
    return np.stack(np.divmod(keys, size), axis=1)


def _rebuilt(vertices: Float, faces: Int) -> Manifold:
    """The manifold of rounded vertices (n, 3) mm and faces (m, 3)."""
    try:
        return from_arrays(vertices, faces)
    except GeometryError as error:
        raise GeometryError(
            f"The part breaks when its coordinates are rounded for a file: {error.message}", _NUDGE
        ) from error


def _without_flat_shells(manifold: Manifold) -> Manifold:
    shells = manifold.decompose()
    kept = [shell for shell in shells if not _is_flat(shell)]
    if not kept:
        raise GeometryError("Nothing of the part is left when its coordinates are rounded.")
    return manifold if len(kept) == len(shells) else together(kept)


def _is_flat(shell: Manifold) -> bool:
    volume, area = abs(shell.volume()), shell.surface_area()
    return bool(volume < _FLAT_SHELL_MM3 and 2 * volume < _FLAT_SHELL_MM * area)


def _apart_at(manifold: Manifold, at: Float) -> Manifold | None:
    """The manifold moved apart only where edges are crowded, the gentlest way; None where it fails.

    at : (k, 3) mm, the ends of its crowded edges.  Elsewhere surfaces may touch in a point: moved
    apart there, they could begin to touch along an edge beside it.
    """
    apart = manifold
    for _ in range(_MOST_ROUNDS):
        apart = _moved_apart(apart, at)
        vertices, faces = _quantized_arrays(apart)
        crowded = crowded_edges(faces)
        if not len(crowded):
            found = _rebuilt(vertices, faces)
            return found if unfaithful(manifold, found, _MOVED_MM) is None else None
        at = vertices[np.unique(crowded)]
    return None


def _moved_apart(manifold: Manifold, at: Float | None = None) -> Manifold:
    """The manifold with vertices that share a position moved a little along their own normals.

    at : (k, 3) mm, the positions where they move, None for all.

    Each moves to the side that its fan of triangles bends to: into the material of a ridge, into
    the void of a groove, so that both touching surfaces draw back.  This works on the manifold as
    the kernel has it, where each of two touching edges has its own vertices; welding joins them.
    """
    exact, faces = arrays(manifold)
    points = rounded(exact)
    _, index = unique_rows(points)
    shared = np.bincount(index)[index] > 1
    if at is not None:
        _, place = unique_rows(np.concatenate([points, at]))
        shared &= np.isin(place[: len(points)], place[len(points) :])
    corners = points[faces]
    normals = area_normals(corners)
    area = np.linalg.norm(normals, axis=1, keepdims=True)
    normal, bend = np.zeros_like(points), np.zeros_like(points)
    for corner in range(3):
        np.add.at(normal, faces[:, corner], normals)
        np.add.at(bend, faces[:, corner], area * (corners.mean(axis=1) - corners[:, corner]))
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    side = np.sign((normal * bend).sum(axis=1, keepdims=True))
    moved = np.where(shared[:, None], points + _APART_MM * side * normal, points)
    return from_arrays(moved, faces)
