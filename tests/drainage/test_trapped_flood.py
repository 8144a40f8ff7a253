"""Basins against the plainest way to find them: a search for the lowest way out of every cell."""

from __future__ import annotations

import heapq
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from printprep.drainage.trapped.flood import basins


def least_spill(cells: np.ndarray, outside: np.ndarray, diagonal: bool) -> dict[tuple, float]:
    """Of every open cell, the height of the highest cell on its lowest way out, by Dijkstra."""
    steps = [s for s in product((-1, 0, 1), repeat=3) if any(s)]
    if not diagonal:
        steps = [s for s in steps if sum(map(abs, s)) == 1]
    best = {tuple(at): np.inf for at in np.argwhere(cells).tolist()}
    queue = []
    for at in best:
        if outside[at]:
            best[at] = at[2]
            queue.append((at[2], at))
    heapq.heapify(queue)
    while queue:
        height, at = heapq.heappop(queue)
        if height > best[at]:
            continue
        for step in steps:
            there = tuple(a + s for a, s in zip(at, step, strict=True))
            if there in best and max(height, there[2]) < best[there]:
                best[there] = max(height, there[2])
                heapq.heappush(queue, (best[there], there))
    return best


@pytest.mark.parametrize("diagonal", [False, True])
@given(cells=arrays(bool, (4, 3, 5)), outside=arrays(bool, (4, 3, 5), elements=st.booleans()))
def test_spills_are_those_of_a_search(diagonal, cells, outside):
    outside = outside & (np.indices(cells.shape)[0] == 0)
    found = basins(cells, outside, diagonal=diagonal)
    for at, height in least_spill(cells, outside, diagonal).items():
        basin = found.basin[found.pool[at]]
        if height == at[2]:
            assert basin == -1
        else:
            assert found.spill[basin] == (-1 if np.isinf(height) else height)


def test_two_bowls_under_one_rim_are_two_basins():
    cells = np.zeros((7, 1, 4), dtype=bool)
    cells[1, 0, 1:] = cells[3:5, 0, :] = True  # two bowls
    cells[:, 0, 2:] = True
    outside = np.zeros_like(cells)
    outside[0] = True
    found = basins(cells, outside, diagonal=False)
    assert found.spill.tolist() == [2, 2]
    assert (found.basin[found.pool[1, 0, 1]], found.basin[found.pool[3, 0, 0]]) in [(0, 1), (1, 0)]
    assert found.basin[found.pool[3, 0, 0]] == found.basin[found.pool[4, 0, 1]]


def test_two_bowls_that_run_together_first_are_one_basin():
    cells = np.zeros((6, 1, 5), dtype=bool)
    cells[1, 0, 0:] = cells[3, 0, 0:] = True
    cells[1:4, 0, 2:] = True  # a saddle between them, below the rim
    cells[:, 0, 4] = True
    outside = np.zeros_like(cells)
    outside[0] = True
    found = basins(cells, outside, diagonal=False)
    assert found.spill.tolist() == [4]


def test_nothing_open_has_no_basins():
    nothing = np.zeros((2, 2, 2), dtype=bool)
    assert len(basins(nothing, ~nothing, diagonal=True).spill) == 0
