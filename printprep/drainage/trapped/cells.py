"""Connected pieces of cells on a grid, and seeds that spread over them.

Cells are bool arrays of shape (nx, ny, nz); a flat index counts them in C order.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Bool, Int

    Int32 = NDArray[np.int32]


def edge_cells(shape: tuple[int, ...]) -> Bool:
    """(nx, ny, nz) bool, the cells at the edge of a grid of that shape."""
    edge = np.ones(shape, dtype=bool)
    edge[1:-1, 1:-1, 1:-1] = False
    return edge


def connected_pieces(cells: Bool, *, diagonal: bool) -> tuple[Int32, int]:
    """Number the connected pieces of cells.

    cells : (nx, ny, nz) bool;  diagonal : whether cells that share only an edge or a corner are
    connected.
    Returns (nx, ny, nz) the piece's number, 0 for none, and the number of the piece outside.
    """
    from scipy.ndimage import generate_binary_structure, label

    pieces, _ = label(cells, structure=generate_binary_structure(3, 3 if diagonal else 1))
    return pieces, int(pieces[0, 0, 0])


def spread_within(cells: Bool, seeds: Int32) -> Int32:
    """Spread seeds through cells, side by side; the first seed to reach a cell keeps it.

    cells : (nx, ny, nz) bool;  seeds : (nx, ny, nz) numbers, 0 for none.
    Returns (nx, ny, nz) the number of each cell's seed, 0 where none reaches it.
    """
    owner = np.where(cells, seeds, 0).ravel()
    allowed = cells.ravel()
    nx, ny, nz = cells.shape
    steps = (ny * nz, -ny * nz, nz, -nz, 1, -1)
    front = _rim(owner.reshape(cells.shape), cells)
    while len(front):
        reached = []
        for axis, step in enumerate(steps):
            there = front + step
            inside = _same_line(front, there, axis // 2, (nx, ny, nz))
            source, target = front[inside], there[inside]
            fresh = allowed[target] & (owner[target] == 0)
            owner[target[fresh]] = owner[source[fresh]]
            reached.append(target[fresh])
        front = np.unique(np.concatenate(reached))
    return owner.reshape(cells.shape)


def _rim(owner: Int32, cells: Bool) -> Int:
    """(n,) flat, owned cells with an allowed neighbour that is not owned yet.

    owner, cells : (nx, ny, nz).
    """
    waiting = cells & (owner == 0)
    beside = np.zeros(cells.shape, dtype=bool)
    for axis in range(3):
        first = tuple(slice(1, None) if a == axis else slice(None) for a in range(3))
        last = tuple(slice(None, -1) if a == axis else slice(None) for a in range(3))
        beside[first] |= waiting[last]
        beside[last] |= waiting[first]
    return np.flatnonzero(beside & (owner > 0))


def _same_line(here: Int, there: Int, axis: int, shape: tuple[int, int, int]) -> Bool:
    """(n,) bool, which steps along an axis stay within the grid; flat indices (n,) to (n,)."""
    _, ny, nz = shape
    inside: Bool = (there >= 0) & (there < shape[0] * ny * nz)
    if axis == 1:
        inside &= here // (ny * nz) == there // (ny * nz)
    elif axis == 2:
        inside &= here // nz == there // nz
    return inside


def cells_of_each(owner: Int32, count: int) -> list[tuple[int, Int]]:
    """The flat cells (m,) of every number from 1 to ``count`` that has any.

    owner : (nx, ny, nz) numbers.
    """
    flat = owner.ravel()
    mine = np.flatnonzero((flat > 0) & (flat <= count))
    order = np.argsort(flat[mine], kind="stable")
    numbers, starts = np.unique(flat[mine][order], return_index=True)
    return list(zip(numbers.tolist(), np.split(mine[order], starts[1:]), strict=True))
