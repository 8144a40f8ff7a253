"""Basins: cells from which every way out rises, found by uniting layers from below.

Notation: a pool is a connected piece of one layer of open cells; its layer is its height.  The
spill of a pool is the least height, over all ways out, of the highest layer on the way.  A basin is
a set of connected pools below a common spill.

The same flood answers two questions.  Liquid in a standing part leaves sideways and down, so liquid
below its spill stays.  While a part prints, air reaches a pool at layer i only through the layers
up to i, so a pool below its spill is a suction cup until then.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise, product
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Bool, Int

    Int32 = NDArray[np.int32]


@dataclass(frozen=True, eq=False)
class Basins:
    """Basins of open cells, layers along the last axis.

    pool : (nx, ny, nz) int32, number of the pool, 0 where closed.
    layer : (n + 1,) layer of each pool;  basin : (n + 1,) its basin, −1 where it drains.
    spill : (b,) layer at which each basin runs over, −1 where it never does.
    """

    pool: Int32
    layer: Int
    basin: Int
    spill: Int


def basins(open_cells: Bool, outside: Bool, *, diagonal: bool) -> Basins:
    """Find the basins of open cells.

    Parameters
    ----------
    open_cells, outside : (nx, ny, nz) bool, z upward; open cells outside are out.
    diagonal : whether cells that share only an edge or a corner are connected.
    """
    from scipy.ndimage import generate_binary_structure, label

    flat = generate_binary_structure(3, 3 if diagonal else 1)
    flat[:, :, [0, 2]] = False
    pool, count = label(open_cells, structure=flat)
    layer = np.zeros(count + 1, dtype=np.int64)
    at = np.flatnonzero(pool)
    layer[pool.flat[at]] = at % open_cells.shape[2]
    free = np.zeros(count + 1, dtype=bool)
    free[np.unique(pool[outside & open_cells])] = True
    basin, spill = _flood(layer, free, _contacts(pool, diagonal))
    return Basins(pool, layer, basin, spill)


def _contacts(pool: Int32, diagonal: bool) -> Int:
    """(k, 2) pools that touch, the lower one first.

    pool : (nx, ny, nz), number of each cell's pool.
    """
    found = [np.zeros((0, 2), dtype=np.int64)]
    below, above = pool[:, :, :-1], pool[:, :, 1:]
    for i, j in product((-1, 0, 1), repeat=2) if diagonal else [(0, 0)]:
        low = below[_span(i, -1), _span(j, -1)]
        high = above[_span(i, 1), _span(j, 1)]
        telling = (low > 0) & (high > 0)
        # A contact that the neighbour along y shows already does not repeat.
        same = (low[:, 1:] == low[:, :-1]) & (high[:, 1:] == high[:, :-1])
        telling[:, 1:] &= ~(same & telling[:, :-1])
        pairs = np.stack([low[telling], high[telling]], axis=1).astype(np.int64)
        found.append(np.unique(pairs, axis=0))
    return np.unique(np.concatenate(found), axis=0)


def _span(step: int, side: int) -> slice:
    """The cells of one axis with a neighbour ``step`` away, or those neighbours."""
    if step == 0:
        return slice(None)
    return slice(1, None) if step * side > 0 else slice(None, -1)


def _flood(layer: Int, free: Bool, contacts: Int) -> tuple[Int, Int]:
    """Basin (n + 1,) of every pool, and spill (b,) of every basin; pool 0 is the outside.

    layer : (n + 1,);  free : (n + 1,) bool, pools that are out;  contacts : (k, 2).
    """
    out = np.flatnonzero(free)
    pairs = np.concatenate([contacts, np.stack([np.zeros_like(out), out], axis=1)])
    height = layer[pairs[:, 1]]
    order = np.argsort(height, kind="stable")
    ends = np.searchsorted(height[order], np.arange(int(layer.max()) + 2))
    pairs_up = pairs[order].tolist()
    joined = _Joined(len(layer))
    held = [[pool] for pool in range(len(layer))]
    basin = np.full(len(layer), -1, dtype=np.int64)
    spill: list[int] = []
    for level, (start, stop) in enumerate(pairwise(ends.tolist())):
        # Basins from below this layer stay apart until the layer lets them out or not.
        for head, sets in joined.all_of(pairs_up[start:stop]).items():
            if head:
                held[head] = [pool for one in sets for pool in held[one]]
                continue
            for one in sets:
                below = [pool for pool in held[one] if layer[pool] < level and pool]
                if below:
                    basin[below] = len(spill)
                    spill.append(level)
                held[one] = []
    for pool in range(1, len(layer)):
        if joined.head(pool) == pool:
            basin[held[pool]] = len(spill)
            spill.append(-1)
    return basin, np.array(spill, dtype=np.int64)


class _Joined:
    """Disjoint sets of numbers, each with a head; the head of 0's set is always 0."""

    def __init__(self, count: int) -> None:
        self._above = list(range(count))

    def head(self, one: int) -> int:
        """The head of a number's set."""
        above = self._above
        while above[one] != one:
            above[one] = above[above[one]]
            one = above[one]
        return one

    def all_of(self, pairs: list[list[int]]) -> dict[int, list[int]]:
        """Join pairs; returns each new set's head, with the heads of the sets it joins."""
        became: dict[int, list[int]] = {}
        for first, second in pairs:
            a, b = self.head(first), self.head(second)
            if a == b:
                continue
            if b == 0 or (a and len(became.get(a, (a,))) < len(became.get(b, (b,)))):
                a, b = b, a
            became[a] = became.pop(a, [a]) + became.pop(b, [b])
            self._above[b] = a
        return became
