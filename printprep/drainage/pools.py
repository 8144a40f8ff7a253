"""What stays in a cavity as it stands: pools, by where the centre of a ball can roll.

Its places are a network of dexels, upright stretches over the grid's columns: two of neighbouring
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
    from printprep.arrays import Bool, Float, Int
    from printprep.drainage.balls import Balls
    from printprep.drainage.channel import Channel
    from printprep.drainage.dexels import Dexels
    from printprep.types import Grid

# Floors fall toward an outlet by this much of the way there: about half a degree.
SLOPE = 0.01
# Liquid that stands lower than this is a film.
LEAST_MM = 0.01
# Filled floors lie this much above the channel's, so that they meet it from above.
RAISED_MM = 0.1
# A ball that only just fits has this much of its column for itself.
SHORTEST_MM = 0.01
# A dexel that ends this near to a height passes by it.
NEAR_MM = 0.15


@dataclass(frozen=True, eq=False)
class Outlet:
    """Where a cavity empties: the dexels that an outlet's inner end touches, and to what level."""

    dexels: Int
    level_mm: float


class Pools:
    """The centres of a ball in a cavity as a network in which it rolls, and what it leaves."""

    def __init__(self, balls: Balls, grid: Grid, *, diagonal: bool = True) -> None:
        """diagonal : whether balls roll between columns that touch by an edge alone."""
        self.balls = balls
        self._steps = 4 if diagonal else 2
        self.grid = grid
        self.dexels = dexels = balls.dexels
        self.volume_mm3 = balls.volume_mm3
        self._long_mm = np.maximum(dexels.high_mm - dexels.low_mm, SHORTEST_MM)

    @cached_property
    def _links(self) -> tuple[Int, Int, Float]:
        """Pairs of joined dexels, each both ways, sorted by the first: starts, others, ways."""
        _, ny, _ = self.grid.shape
        column = self.dexels.column
        count = len(column)
        order = np.arange(count)
        ends: list[tuple[Int, Int, Float]] = []
        steps = ((ny, 1.0), (1, 1.0), (ny + 1, 2**0.5), (ny - 1, 2**0.5))
        for step, way in steps[: self._steps]:
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

    def tops_mm(self, channels: Sequence[Channel]) -> Float:
        """(k,) how high every void cell has to be filled so that the rest drains, else −inf.

        What a ball cannot leave reaches up to a radius below where its centre passes out.
        """
        levels = self.levels(self.outlets(channels))
        wet = levels > self.dexels.low_mm + LEAST_MM
        tops = np.where(wet, levels - self.balls.radius_mm, -np.inf)
        nearest = self.balls.nearest
        if not len(tops):
            return np.full(len(nearest), np.inf)
        # A void that holds no ball is left to smaller ones
        return np.where(nearest >= 0, tops[nearest], -np.inf)

    def standing_mm(self, levels: Float) -> Float:
        """(n,) how high liquid stands over each dexel's floor."""
        high = np.maximum(self.dexels.high_mm, self.dexels.low_mm + SHORTEST_MM)
        return np.minimum(levels, high) - self.dexels.low_mm

    def largest(self, standing_mm: Float, excluded: Int) -> tuple[Int, float]:
        """The dexels of the pool that holds most, and what it holds in mm³.

        excluded : dexels whose pools are not asked for.
        """
        label = self.connected(standing_mm > 0)
        held = self.volume_mm3 * np.minimum(standing_mm / self._long_mm, 1.0)
        volume = np.bincount(label[label >= 0], weights=held[label >= 0])
        volume[label[excluded][label[excluded] >= 0]] = 0.0
        if not len(volume) or volume.max() <= 0:
            return np.zeros(0, dtype=np.int64), 0.0
        number = int(volume.argmax())
        return np.flatnonzero(label == number), float(volume[number])

    def held_below_mm3(self, pool: Int, levels_mm: Float) -> Float:
        """(n,) what some dexels hold below each of these levels."""
        deep = (levels_mm[:, None] - self.dexels.low_mm[pool]) / self._long_mm[pool]
        result: Float = np.clip(deep, 0.0, 1.0) @ self.volume_mm3[pool]
        return result

    def outlets(self, channels: Sequence[Channel]) -> list[Outlet]:
        """Where these channels drain the network, and down to what level."""
        lower = self.balls.radius_mm + RAISED_MM
        return [Outlet(self.over(channel), channel.floor_mm + lower) for channel in channels]

    def over(self, channel: Channel) -> Int:
        """The dexels that pass by a channel's inner end."""
        point = channel.inner_mm
        # A smaller ball rests lower in the one at the end
        spare = channel.diameter_mm / 2 - self.balls.radius_mm
        reach_mm = max(0.3 * channel.diameter_mm, 0.75 * self.grid.pitch_mm)
        i, j = np.divmod(self.dexels.column, self.grid.shape[1])
        x, y = (self.grid.origin_mm[a] + self.grid.pitch_mm * k for a, k in ((0, i), (1, j)))
        near = np.hypot(x - point[0], y - point[1]) <= reach_mm
        near &= self.dexels.low_mm <= point[2] + NEAR_MM
        near &= self.dexels.high_mm >= point[2] - spare - NEAR_MM
        return np.flatnonzero(near)

    def holding(self, others: Dexels) -> Int:
        """(m,) the dexel that each of some others, of a larger ball, lies in, −1 where none."""
        own = self.dexels
        middle = (others.low_mm + others.high_mm) / 2
        if not len(own.column):
            return np.full(len(middle), -1, dtype=np.int64)
        # One key in the order of dexels: columns are farther apart than any two heights
        apart = 1.0 + 2.0 * float(np.abs(np.concatenate([own.low_mm, middle])).max())
        key = own.column * apart + own.low_mm
        found = np.searchsorted(key, others.column * apart + middle, side="right") - 1
        inside = (own.column[found] == others.column) & (own.high_mm[found] >= middle)
        return np.where((found >= 0) & inside, found, -1)

    def connected(self, wet: Bool) -> Int:
        """(n,) the number of the pool that each wet dexel belongs to, else −1."""
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
