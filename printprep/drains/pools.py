"""What stays in a cavity when it is tipped out upright: pools, from the floor's own heights.

The cavity is a network of dexels, upright stretches over the grid's columns: two of neighbouring
columns join where they overlap.  Priority flood (Barnes, Lehman and Mulla, "Priority-flood",
Computers & Geosciences 62, 2014) gives each the level down to which it empties through the outlets
there are: the lowest pass on the way, and a slope along it, so that what is filled up to that level
drains too.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.drains.space import Dexels
    from printprep.types import Bool, Float, Grid, Int

# Floors fall toward an outlet by this much of the way there: about half a degree.
SLOPE = 0.01


@dataclass(frozen=True, eq=False)
class Outlet:
    """Where a cavity empties: the dexels that an outlet's inner end touches, and to what level."""

    dexels: Int
    level_mm: float


class Pools:
    """The dexels of a cavity as a network in which liquid stands."""

    def __init__(self, dexels: Dexels, grid: Grid) -> None:
        self.dexels = dexels
        self.grid = grid
        self.area_mm2 = grid.pitch_mm**2

    @cached_property
    def _links(self) -> tuple[Int, Int, Float]:
        """Pairs of joined dexels, each both ways, sorted by the first: starts, others, ways."""
        _, ny, _ = self.grid.shape
        column = self.dexels.column
        count = len(column)
        order = np.arange(count)
        ends: list[tuple[Int, Int, Float]] = []
        for step, way in ((ny, 1.0), (1, 1.0), (ny + 1, 2**0.5), (ny - 1, 2**0.5)):
            first = np.searchsorted(column, column + step, side="left")
            last = np.searchsorted(column, column + step, side="right")
            times = last - first
            a = np.repeat(order, times)
            b = (
                np.arange(len(a))
                - np.repeat(np.cumsum(times) - times, times)
                + np.repeat(first, times)
            )
            low = np.maximum(self.dexels.low_mm[a], self.dexels.low_mm[b])
            high = np.minimum(self.dexels.high_mm[a], self.dexels.high_mm[b])
            joined = high > low
            ends.append((a[joined], b[joined], np.full(int(joined.sum()), way)))
        a, b, way_ = (np.concatenate(parts) for parts in zip(*ends, strict=True))
        from_, to = np.concatenate([a, b]), np.concatenate([b, a])
        sorting = np.argsort(from_, kind="stable")
        starts = np.searchsorted(from_[sorting], np.arange(count + 1))
        ways = np.concatenate([way_, way_])[sorting] * self.grid.pitch_mm
        return starts, to[sorting], ways

    def levels(self, outlets: Sequence[Outlet], slope: float = SLOPE) -> Float:
        """(n,) level in mm down to which each dexel empties, at least its floor; inf where none.

        A dexel at its own floor is empty.  slope : of the liquid's surface, 0 as it stands.
        """
        starts, others, ways = self._links
        first, to, rise = starts.tolist(), others.tolist(), (slope * ways).tolist()
        floor = self.dexels.low_mm.tolist()
        ceiling = self.dexels.high_mm.tolist()
        level = [np.inf] * len(floor)
        heap: list[tuple[float, int]] = []
        for outlet in outlets:
            for dexel in outlet.dexels.tolist():
                height = max(outlet.level_mm, floor[dexel])
                if height < level[dexel]:
                    level[dexel] = height
                    heap.append((height, dexel))
        heapq.heapify(heap)
        while heap:
            height, dexel = heapq.heappop(heap)
            if height > level[dexel]:
                continue
            for link in range(first[dexel], first[dexel + 1]):
                other = to[link]
                through = max(height + rise[link], floor[other])
                # Over the pass there must be room left under both ceilings
                if through < level[other] and through < ceiling[other] and through < ceiling[dexel]:
                    level[other] = through
                    heapq.heappush(heap, (through, other))
        return np.array(level)

    def standing_mm(self, levels: Float) -> Float:
        """(n,) how high liquid stands over each dexel's floor."""
        return np.minimum(levels, self.dexels.high_mm) - self.dexels.low_mm

    def largest(self, standing_mm: Float, excluded: Int) -> tuple[Int, float]:
        """The dexels of the pool that holds most, and what it holds in mm³.

        excluded : dexels whose pools are not asked for.
        """
        label = self._connected(standing_mm > 0)
        volume = np.bincount(label[label >= 0], weights=standing_mm[label >= 0] * self.area_mm2)
        volume[label[excluded][label[excluded] >= 0]] = 0.0
        if not len(volume) or volume.max() <= 0:
            return np.zeros(0, dtype=np.int64), 0.0
        number = int(volume.argmax())
        return np.flatnonzero(label == number), float(volume[number])

    def components(self) -> Int:
        """(n,) which connected part of the void each dexel belongs to."""
        return self._connected(np.ones(len(self.dexels.column), dtype=bool))

    def _connected(self, wet: Bool) -> Int:
        from scipy.sparse import csr_array
        from scipy.sparse.csgraph import connected_components

        starts, others, _ = self._links
        from_ = np.repeat(np.arange(len(wet)), np.diff(starts))
        both = wet[from_] & wet[others]
        links = csr_array(
            (np.ones(int(both.sum()), dtype=bool), (from_[both], others[both])),
            shape=(len(wet), len(wet)),
        )
        _, label = connected_components(links, directed=False)
        return np.where(wet, label, -1).astype(np.int64)
