"""Pools: what stays in a cavity as it stands, by where the centre of a ball can roll.

The ball's places are a network of dexels, vertical stretches over the grid's columns; two of
neighbouring columns join where they overlap.  Priority flood (Barnes, Lehman and Mulla,
"Priority-flood", Computers & Geosciences 62, 2014) gives each dexel the level down to which it
empties through the outlets: the lowest pass on the way, plus a slope along it, so that a floor
filled up to that level drains too.
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

# Filled floors fall toward an outlet by this share of the way there: about half a degree.
SLOPE = 0.01
# Liquid that stands lower than this is a film.
LEAST_MM = 0.01
# Filled floors lie this much above the channel's floor, so that they meet it from above.
RAISED_MM = 0.1
# A dexel counts as at least this long, where a ball only just fits.
SHORTEST_MM = 0.01
# A dexel that ends this near to a height still reaches it.
NEAR_MM = 0.15


@dataclass(frozen=True, eq=False)
class Outlet:
    """Where a cavity empties.

    dexels : (k,) those that an outlet's inner end touches;  level_mm : height down to which they
    empty.
    """

    dexels: Int
    level_mm: float


class Pools:
    """The network in which a ball's centre rolls through a cavity, and the pools it leaves."""

    def __init__(self, balls: Balls, grid: Grid, *, diagonal: bool = True) -> None:
        """diagonal : whether balls roll between columns that share only an edge."""
        self.balls = balls
        self._steps = 4 if diagonal else 2
        self.grid = grid
        self.dexels = dexels = balls.dexels
        self.volume_mm3 = balls.volume_mm3
        self._long_mm = np.maximum(dexels.high_mm - dexels.low_mm, SHORTEST_MM)

    @cached_property
    def _links(self) -> tuple[Int, Int, Float]:
        """The joined pairs of dexels, each both ways, sorted by the first.

        starts : (n + 1,) where the links of each dexel begin;  others : (m,) the dexel at the other
        end of each link;  ways : (m,) mm, the links' lengths.
        """
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
        """(n,) mm, level down to which each dexel empties, at least its floor; inf for not at all.

        A dexel at its own floor is empty.  slope : of the liquid's surface, 0 at rest.
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
                # The pass lies below both ceilings
                if through < level[other] and through < ceiling[other] and through < ceiling[dexel]:
                    level[other] = through
                    heapq.heappush(heap, (through, other))
        return np.array(level)

    def tops_mm(self, channels: Sequence[Channel]) -> Float:
        """(k,) mm, height up to which every void cell is filled so that the rest drains, else −inf.

        Liquid that a ball cannot leave reaches up to a radius below its centre's way out.
        """
        levels = self.levels(self.outlets(channels))
        wet = levels > self.dexels.low_mm + LEAST_MM
        tops = np.where(wet, levels - self.balls.radius_mm, -np.inf)
        nearest = self.balls.nearest
        if not len(tops):
            return np.full(len(nearest), np.inf)
        # A void that holds no ball is left to smaller balls
        return np.where(nearest >= 0, tops[nearest], -np.inf)

    def liquid_depth_mm(self, levels: Float) -> Float:
        """(n,) mm, height of the liquid over each dexel's floor, at levels (n,) mm."""
        high = np.maximum(self.dexels.high_mm, self.dexels.low_mm + SHORTEST_MM)
        return np.minimum(levels, high) - self.dexels.low_mm

    def largest(self, depth_mm: Float, excluded: Int) -> tuple[Int, float]:
        """The dexels (k,) of the pool that holds most, and its volume in mm³.

        depth_mm : (n,) mm, height of the liquid over each floor;  excluded : (m,) dexels whose
        pools do not count.
        """
        label = self.connected(depth_mm > 0)
        held = self.volume_mm3 * np.minimum(depth_mm / self._long_mm, 1.0)
        volume = np.bincount(label[label >= 0], weights=held[label >= 0])
        volume[label[excluded][label[excluded] >= 0]] = 0.0
        if not len(volume) or volume.max() <= 0:
            return np.zeros(0, dtype=np.int64), 0.0
        number = int(volume.argmax())
        return np.flatnonzero(label == number), float(volume[number])

    def held_below_mm3(self, pool: Int, levels_mm: Float) -> Float:
        """(m,) mm³, what the dexels of a pool (k,) hold below each of the levels (m,) mm."""
        deep = (levels_mm[:, None] - self.dexels.low_mm[pool]) / self._long_mm[pool]
        result: Float = np.clip(deep, 0.0, 1.0) @ self.volume_mm3[pool]
        return result

    def outlets(self, channels: Sequence[Channel]) -> list[Outlet]:
        """Where channels drain the network, and down to what level."""
        lower = self.balls.radius_mm + RAISED_MM
        return [Outlet(self.over(channel), channel.floor_mm + lower) for channel in channels]

    def over(self, channel: Channel) -> Int:
        """(k,) the dexels that pass by a channel's inner end."""
        point = channel.inner_mm
        # A smaller ball rests lower in the ball at the end
        spare = channel.diameter_mm / 2 - self.balls.radius_mm
        reach_mm = max(0.3 * channel.diameter_mm, 0.75 * self.grid.pitch_mm)
        i, j = np.divmod(self.dexels.column, self.grid.shape[1])
        x, y = (self.grid.origin_mm[a] + self.grid.pitch_mm * k for a, k in ((0, i), (1, j)))
        near = np.hypot(x - point[0], y - point[1]) <= reach_mm
        near &= self.dexels.low_mm <= point[2] + NEAR_MM
        near &= self.dexels.high_mm >= point[2] - spare - NEAR_MM
        return np.flatnonzero(near)

    def holding(self, others: Dexels) -> Int:
        """(m,) the dexel that each dexel of a larger ball lies in, −1 for none."""
        own = self.dexels
        middle = (others.low_mm + others.high_mm) / 2
        if not len(own.column):
            return np.full(len(middle), -1, dtype=np.int64)
        # One key in the order of dexels: columns lie farther apart than any two heights
        apart = 1.0 + 2.0 * float(np.abs(np.concatenate([own.low_mm, middle])).max())
        key = own.column * apart + own.low_mm
        found = np.searchsorted(key, others.column * apart + middle, side="right") - 1
        inside = (own.column[found] == others.column) & (own.high_mm[found] >= middle)
        return np.where((found >= 0) & inside, found, -1)

    def connected(self, wet: Bool) -> Int:
        """(n,) the number of the pool that each wet dexel belongs to, else −1.

        wet : (n,) bool.
        """
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
