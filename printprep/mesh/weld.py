"""Welds triangles at their corners, and counts, pairs and groups them by their edges."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import stable_order, unique_keys

if TYPE_CHECKING:
    from typing import TypeVar

    from printprep.arrays import Bool, Float, Int

    Rows = TypeVar("Rows", Float, Int)


@dataclass(frozen=True)
class EdgeCounts:
    """How many edges keep a surface from being closed.

    open_edges : undirected edges whose two directions are not used equally often;
    crowded_edges : undirected edges with more than two faces.
    """

    open_edges: int
    crowded_edges: int


# Two corners closer than this, relative to the size of the model, are one corner, rounded to single
# precision in two ways: four units in the last place of a float32 (2⁻²⁴ each).
_NOISE = 4 * 2.0**-24
# The share of corners that tell how large the model is: one that is damaged must not.
_USUAL = 0.99


@dataclass(frozen=True, eq=False)
class Welded:
    """A welded mesh.

    vertices : (n, 3);  faces : (m, 3);  kept : (m,) which of the faces given each one was.
    """

    vertices: Float
    faces: Int
    kept: Int


def weld(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """The vertices (n, 3) and faces (m, 3) of :func:`welded`."""
    found = welded(vertices, faces)
    return found.vertices, found.faces


def welded(vertices: Float, faces: Int) -> Welded:
    """Join vertices at one position, and drop faces with a repeated corner and unused vertices.

    vertices : (n, 3);  faces : (m, 3);  returns both, with fewer rows.  Positions are joined where
    they are equal to the last bit: files repeat a shared corner literally (STL always, OBJ and GLB
    at seams of texture or normal).  Where that leaves the surface open, corners that differ by the
    rounding of single precision are joined too, if that closes edges.  A wider gap is left to
    repair.

    A face that collapses uses one edge in both directions, so dropping it opens nothing; a face
    without area but with three distinct corners is kept for the same reason.
    """
    exact = _weld_equal(vertices, faces)
    if is_closed(exact.faces, once=False):
        return exact
    size = float(np.quantile(np.abs(exact.vertices).max(axis=1), _USUAL))
    near = _weld_near(exact, _NOISE * size)
    still_open = edge_counts(exact.faces).open_edges
    fewer = len(near.kept) and edge_counts(near.faces).open_edges < still_open
    return near if fewer else exact


def _weld_equal(vertices: Float, faces: Int) -> Welded:
    """Vertices (n, 3) and faces (m, 3) with equal positions joined."""
    positions, group = unique_rows(vertices + 0.0)  # −0.0 and 0.0 are one position
    return _kept(positions, group[faces])


def unique_rows(rows: Rows) -> tuple[Rows, Int]:
    """The different rows of (n, 3) in lexicographic order, and (n,) which of them each row is.

    Like ``numpy.unique`` along the first axis, in a fraction of the time.
    """
    order = np.argsort(rows[:, 0])
    ordered = rows[order]
    fresh = np.ones(len(order), dtype=bool)
    fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    # Rows that begin alike follow each other in any order: those of such a run that are not all
    # alike are put in order among themselves.
    begins = np.ones(len(order), dtype=bool)
    begins[1:] = ordered[1:, 0] != ordered[:-1, 0]
    run = np.cumsum(begins) - 1
    mixed = np.zeros(len(order), dtype=bool)
    mixed[run[fresh & ~begins]] = True
    again = np.flatnonzero(mixed[run])
    if len(again):
        order[again] = order[again][np.lexsort(ordered[again].T[::-1])]
        ordered[again] = rows[order[again]]
        fresh[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(fresh) - 1
    return ordered[fresh], group


def _weld_near(mesh: Welded, tolerance: float) -> Welded:
    """A mesh with vertices that are near each other joined to the first one."""
    if not tolerance > 0.0:
        return mesh
    near = _kept(mesh.vertices, first_near(mesh.vertices, tolerance)[mesh.faces])
    return Welded(near.vertices, near.faces, mesh.kept[near.kept])


def first_near(points: Float, tolerance: float) -> Int:
    """(n,) for each of points (n, 3) the first one near it, directly or through others.

    It takes time linear in them.  Cells are cubes of twice the tolerance in eight grids, each moved
    by half a cell along some axes: points within the tolerance along each axis share a cell in one
    of them, and those of one cell are near.
    """
    scaled = points / (2 * tolerance)
    one, other = [], []
    for corner in range(8):
        shift = np.array([corner & 1, corner >> 1 & 1, corner >> 2 & 1]) / 2
        cells = np.floor(scaled + shift)
        order = np.lexsort(cells.T)
        same = np.flatnonzero((cells[order][1:] == cells[order][:-1]).all(axis=1))
        one.append(order[same])
        other.append(order[same + 1])
    return first_connected(np.concatenate(one), np.concatenate(other), len(points))


def _kept(vertices: Float, faces: Int) -> Welded:
    """A mesh without faces (m, 3) that use a vertex twice, and without unused vertices (n, 3)."""
    kept = np.flatnonzero(distinct(faces))
    return Welded(*compact(vertices, faces[kept]), kept)


def first_connected(one: Int, other: Int, count: int) -> Int:
    """(count,) for each of ``count`` things the first one that it is connected to, or itself.

    one, other : (k,) the two ends of each link; things are connected directly or through others.
    """
    label = connected(one, other, count)
    first, group = unique_keys(label.astype(np.int64))
    return first[group]


def connected(one: Int, other: Int, count: int) -> Int:
    """(count,) number of the connected component of each thing; one, other : (k,) ends of links."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    links = coo_matrix((np.ones(len(one), dtype=np.int8), (one, other)), shape=(count, count))
    label: Int = connected_components(links, directed=False)[1]
    return label


def drop_collapsed(faces: Int) -> Int:
    """Faces (m, 3) without those that use a vertex twice."""
    kept: Int = faces[distinct(faces)]
    return kept


def distinct(faces: Int) -> Bool:
    """(m,) whether the corners of faces (m, 3) are three."""
    a, b, c = faces.T
    distinct: Bool = (a != b) & (b != c) & (c != a)
    return distinct


def compact(vertices: Float, faces: Int) -> tuple[Float, Int]:
    """The vertices (n, 3) that faces (m, 3) use, in the order of first use, and the new faces."""
    corners = faces.ravel()
    first, index = unique_keys(corners)
    by_use = stable_order(first)
    rank = np.empty(len(first), dtype=np.int64)
    rank[by_use] = np.arange(len(first))
    return vertices[corners[first[by_use]]], rank[index.reshape(-1, 3)]


def in_order(faces: Int) -> Int:
    """Faces (m, 3), each from its smallest vertex on, sorted: the same for any order of them."""
    a, b, c = faces.T
    second, third = (b < a) & (b <= c), (c < a) & (c < b)
    x, y, z = (
        np.where(second, second_first, np.where(third, third_first, as_it_is))
        for as_it_is, second_first, third_first in ((a, b, c), (b, c, a), (c, a, b))
    )
    size = int(faces.max(initial=0)) + 1
    if size.bit_length() <= 21:  # three fit into one number
        order = np.argsort((x * size + y) * size + z)  # where two are equal, so are the faces
    else:
        order = np.lexsort((z, y, x))
    return np.stack([x, y, z], axis=1)[order]


def directed_edges(faces: Int) -> Int:
    """(3m, 2) vertex pairs (from, to) of faces (m, 3), face by face, three of each in order."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)


def is_closed(faces: Int, *, once: bool) -> bool:
    """Whether each edge of faces (m, 3) runs as often one way as the other; once: once each way.

    An edge with an even number of faces may be balanced without being a manifold one.
    """
    edges = directed_edges(faces)
    size = int(faces.max(initial=0)) + 1
    start, end = edges.T
    there, back = np.sort(start * size + end), np.sort(end * size + start)
    if once and (there[1:] == there[:-1]).any():
        return False
    return np.array_equal(there, back)


def unmatched_edges(faces: Int) -> Int:
    """(k, 2) directed edges that faces (m, 3) lack to be closed, each as often as it is missing."""
    if is_closed(faces, once=False):
        return np.zeros((0, 2), dtype=np.int64)
    edges = directed_edges(faces)
    size = int(faces.max(initial=0)) + 1
    low, high = edges.min(axis=1), edges.max(axis=1)
    keys, index = np.unique(low * size + high, return_inverse=True)
    ends = np.stack(np.divmod(keys, size), axis=1)
    excess = np.bincount(
        index.ravel(), weights=np.where(edges[:, 0] < edges[:, 1], 1, -1), minlength=len(ends)
    ).astype(np.int64)
    forward = np.repeat(ends, np.maximum(-excess, 0), axis=0)
    backward = np.repeat(ends[:, ::-1], np.maximum(excess, 0), axis=0)
    return np.vstack([forward, backward])


def opposite_edges(faces: Int) -> tuple[Int, Int]:
    """(k,) and (k,) for each edge of a closed surface, its two rows in :func:`directed_edges`.

    faces : (m, 3), so k = 3m / 2; one row runs along the edge in each direction.
    """
    edges = np.sort(directed_edges(faces), axis=1)
    size = int(faces.max(initial=0)) + 1
    order = stable_order(edges[:, 0] * size + edges[:, 1])
    return order[0::2], order[1::2]


def edge_counts(faces: Int) -> EdgeCounts:
    """How far faces (m, 3) are from a closed, consistently oriented surface."""
    if len(faces) == 0:
        return EdgeCounts(0, 0)
    edges = directed_edges(faces)
    forward = edges[:, 0] < edges[:, 1]
    low, high = edges.min(axis=1), edges.max(axis=1)
    keys = low * (int(faces.max()) + 1) + high
    _, index, count = np.unique(keys, return_inverse=True, return_counts=True)
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
    order = stable_order(keys)
    ordered, owner = keys[order], owner[order]
    same = ordered[1:] == ordered[:-1]
    a, b = owner[:-1][same], owner[1:][same]
    if not len(faces):
        return []
    label = connected(a, b, len(faces))
    label = label.astype(np.int64)
    groups = np.split(stable_order(label), np.cumsum(np.bincount(label))[:-1])
    return sorted(groups, key=lambda group: (-len(group), int(group[0])))
