"""Making triangles share their corners, and what the edges then say about the surface."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


@dataclass(frozen=True)
class EdgeCounts:
    """open_edges : undirected edges whose two directions are not used equally often;
    crowded_edges : undirected edges with more than two faces."""

    open_edges: int
    crowded_edges: int


# Two corners closer than this, relative to the largest coordinate, are one corner that single
# precision wrote in two ways: four units in the last place of a float32 (2⁻²⁴ each).
_NOISE = 4 * 2.0**-24


def weld(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """One vertex per position, no face with a repeated corner, no vertex without a face.

    Positions are joined when they are equal to the last bit: files repeat a shared corner
    literally (STL always, OBJ and GLB at seams of texture or normal).  Only where that leaves the
    surface open are corners joined that differ by the noise of single precision, and only if that
    closes edges.  Anything wider is a gap, and mending it is repair.

    A face that collapses uses one edge in both directions, so dropping it opens nothing; a face
    of no area but three distinct corners is kept for the same reason.
    """
    joined, corners = _weld_equal(vertices, faces)
    still_open = edge_counts(corners).open_edges
    if still_open:
        near, kept = _weld_near(joined, corners, _NOISE * float(np.abs(joined).max()))
        if len(kept) and edge_counts(kept).open_edges < still_open:
            return near, kept
    return joined, corners


def _weld_equal(vertices: Float, faces: Int) -> tuple[Float, Int]:
    vertices = vertices + 0.0  # −0.0 and 0.0 are one position
    order = np.lexsort(vertices.T)
    ordered = vertices[order]
    fresh = np.ones(len(order), dtype=bool)
    fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(fresh) - 1
    return compact(ordered[fresh], drop_collapsed(group[faces]))


def _weld_near(vertices: Float, faces: Int, tolerance: float) -> tuple[Float, Int]:
    """Vertices within ``tolerance`` of each other become the first of them."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    pairs = cKDTree(vertices).query_pairs(tolerance, output_type="ndarray")
    size = len(vertices)
    links = coo_matrix((np.ones(len(pairs), dtype=np.int8), pairs.T), shape=(size, size))
    _, label = connected_components(links, directed=False)
    _, first = np.unique(label, return_index=True)
    return compact(vertices, drop_collapsed(first[label][faces]))


def drop_collapsed(faces: Int) -> Int:
    """Faces (m, 3) without those that name a vertex twice."""
    a, b, c = faces.T
    kept: Int = faces[(a != b) & (b != c) & (c != a)]
    return kept


def compact(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """The vertices that faces use, in the order the faces first name them."""
    used, first, index = np.unique(faces, return_index=True, return_inverse=True)
    by_use = np.argsort(first, kind="stable")
    rank = np.empty(len(used), dtype=np.int64)
    rank[by_use] = np.arange(len(used))
    return vertices[used[by_use]], rank[index.reshape(-1, 3)]


def directed_edges(faces: Int) -> Int:
    """(3m, 2) from-to vertex pairs, those of a face in order, face by face."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


def opposite_edges(faces: Int) -> tuple[Int, Int]:
    """For every edge of a closed surface, (k,) and (k,) the rows of :func:`directed_edges` that run
    along it: once in each direction."""
    edges = np.sort(directed_edges(faces), axis=1)
    size = int(faces.max(initial=0)) + 1
    order = np.argsort(edges[:, 0] * size + edges[:, 1], kind="stable")
    return order[0::2], order[1::2]


def edge_counts(faces: Int) -> EdgeCounts:
    """How far the faces are from a closed, consistently oriented surface."""
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
    """Every edge (k, 2), smaller vertex first, and the number (k,) of triangles that have it."""
    edges = np.sort(directed_edges(faces), axis=1)
    size = int(faces.max(initial=0)) + 1
    keys, count = np.unique(edges[:, 0] * size + edges[:, 1], return_counts=True)
    return np.stack(np.divmod(keys, size), axis=1), count


def components(faces: Int, vertex_count: int) -> list[Int]:
    """Indices of the faces of each piece that hangs together by shared edges, largest first."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    edges = np.sort(directed_edges(faces), axis=1)
    keys = edges[:, 0] * vertex_count + edges[:, 1]
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(keys, kind="stable")
    same = keys[order][1:] == keys[order][:-1]
    a, b = owner[order][:-1][same], owner[order][1:][same]
    graph = coo_matrix((np.ones(len(a), dtype=np.int8), (a, b)), shape=(len(faces),) * 2)
    count, label = connected_components(graph, directed=False)
    groups = np.split(np.argsort(label, kind="stable"), np.cumsum(np.bincount(label))[:-1])
    return sorted(groups, key=lambda group: (-len(group), int(group[0])))[:count]
