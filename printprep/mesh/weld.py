"""Welds triangles at their corners, and counts, pairs and groups them by their edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


@dataclass(frozen=True)
class EdgeCounts:
    """How many edges keep a surface from being closed.

    open_edges : undirected edges whose two directions are not used equally often;
    crowded_edges : undirected edges with more than two faces.
    """

    open_edges: int
    crowded_edges: int


# Two corners closer than this, relative to the largest coordinate, are one corner, rounded to
# single precision in two ways: four units in the last place of a float32 (2⁻²⁴ each).
_NOISE = 4 * 2.0**-24


def weld(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """Join vertices at one position, and drop faces with a repeated corner and unused vertices.

    vertices : (n, 3);  faces : (m, 3);  returns both, with fewer rows.  Positions are joined where
    they are equal to the last bit: files repeat a shared corner literally (STL always, OBJ and GLB
    at seams of texture or normal).  Where that leaves the surface open, corners that differ by the
    rounding of single precision are joined too, if that closes edges.  A wider gap is left to
    repair.

    A face that collapses uses one edge in both directions, so dropping it opens nothing; a face
    without area but with three distinct corners is kept for the same reason.
    """
    joined, corners = _weld_equal(vertices, faces)
    still_open = edge_counts(corners).open_edges
    if still_open:
        near, kept = _weld_near(joined, corners, _NOISE * float(np.abs(joined).max()))
        if len(kept) and edge_counts(kept).open_edges < still_open:
            return near, kept
    return joined, corners


def _weld_equal(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """Vertices (n, 3) and faces (m, 3) with equal positions joined."""
    vertices = vertices + 0.0  # −0.0 and 0.0 are one position
    order = np.lexsort(vertices.T)
    ordered = vertices[order]
    fresh = np.ones(len(order), dtype=bool)
    fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(fresh) - 1
    return compact(ordered[fresh], drop_collapsed(group[faces]))


def _weld_near(vertices: Float, faces: Int, tolerance: float) -> tuple[Float, Int]:
    """Vertices (n, 3) and faces (m, 3), vertices within ``tolerance`` joined to the first one."""
    from scipy.spatial import cKDTree

    pairs = cKDTree(vertices).query_pairs(tolerance, output_type="ndarray")
    first = first_connected(pairs[:, 0], pairs[:, 1], len(vertices))
    return compact(vertices, drop_collapsed(first[faces]))


def first_connected(one: Int, other: Int, count: int) -> Int:
    """(count,) for each of ``count`` things the first one that it is connected to, or itself.

    one, other : (k,) the two ends of each link; things are connected directly or through others.
    """
    label = connected(one, other, count)
    return np.unique(label, return_index=True)[1][label]


def connected(one: Int, other: Int, count: int) -> Int:
    """(count,) number of the connected component of each thing; one, other : (k,) ends of links."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    links = coo_matrix((np.ones(len(one), dtype=np.int8), (one, other)), shape=(count, count))
    label: Int = connected_components(links, directed=False)[1]
    return label


def drop_collapsed(faces: Int) -> Int:
    """Faces (m, 3) without those that use a vertex twice."""
    a, b, c = faces.T
    kept: Int = faces[(a != b) & (b != c) & (c != a)]
    return kept


def compact(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """The vertices (n, 3) that faces (m, 3) use, in the order of first use, and the new faces."""
    used, first, index = np.unique(faces, return_index=True, return_inverse=True)
    by_use = np.argsort(first, kind="stable")
    rank = np.empty(len(used), dtype=np.int64)
    rank[by_use] = np.arange(len(used))
    return vertices[used[by_use]], rank[index.reshape(-1, 3)]


def directed_edges(faces: Int) -> Int:
    """(3m, 2) vertex pairs (from, to) of faces (m, 3), face by face, three of each in order."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


def opposite_edges(faces: Int) -> tuple[Int, Int]:
    """(k,) and (k,) for each edge of a closed surface, its two rows in :func:`directed_edges`.

    faces : (m, 3), so k = 3m / 2; one row runs along the edge in each direction.
    """
    edges = np.sort(directed_edges(faces), axis=1)
    size = int(faces.max(initial=0)) + 1
    order = np.argsort(edges[:, 0] * size + edges[:, 1], kind="stable")
    return order[0::2], order[1::2]


def edge_counts(faces: Int) -> EdgeCounts:
    """How far faces (m, 3) are from a closed, consistently oriented surface."""
    if len(faces) == 0:
        return EdgeCounts(0, 0)
    edges = directed_edges(faces)
    forward = edges[:, 0] < edges[:, 1]
    _, index, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    balance = np.bincount(index.ravel(), weights=np.where(forward, 1.0, -1.0))
    return EdgeCounts(int((balance != 0).sum()), int((count > 2).sum()))


def shared_edges(faces: Int) -> tuple[Int, Int]:
    """(k, 2) every edge of faces (m, 3), smaller vertex first, and (k,) its number of faces."""
    edges = np.sort(directed_edges(faces), axis=1)
    size = int(faces.max(initial=0)) + 1
    keys, count = np.unique(edges[:, 0] * size + edges[:, 1], return_counts=True)
    return np.stack(np.divmod(keys, size), axis=1), count


def components(faces: Int, vertex_count: int) -> list[Int]:
    """(k,) face indices of each piece of surface connected by shared edges, largest piece first.

    faces : (m, 3), which use the vertices 0 … vertex_count − 1.
    """
    edges = np.sort(directed_edges(faces), axis=1)
    keys = edges[:, 0] * vertex_count + edges[:, 1]
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    a, b = owner[order][:-1][same], owner[order][1:][same]
    if not len(faces):
        return []
    label = connected(a, b, len(faces))
    groups = np.split(np.argsort(label, kind="stable"), np.cumsum(np.bincount(label))[:-1])
    return sorted(groups, key=lambda group: (-len(group), int(group[0])))
