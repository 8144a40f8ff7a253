"""Drain a part: outlets where liquid would stand, vents where air has to come in, and the rest
filled.

Upright on its plate, as it is printed.  Every pool that holds enough gets an outlet at its lowest
place that the hole's own ball reaches; what no outlet drains is filled, with floors that fall
toward an outlet.  So no layer closes off a region from the air: nothing is trapped, and nothing
sucks at the vat.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import cavities_of
from printprep.drains.channel import Channel, bored
from printprep.drains.fill import filling
from printprep.drains.pools import Outlet, Pools
from printprep.drains.probe import channel_along
from printprep.drains.search import AWAY_MM, DEPTH_MM, FILLED_MM, balls_at_rest, ways_out
from printprep.drains.space import space_of
from printprep.voxel.distance import Surface

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.drains.search import Candidate, Role
    from printprep.types import Float, Int

# A pool that holds less is filled: a hole would cost more looks than it saves.
LEAST_POOL_MM3 = 150.0
# What stands no higher than this counts for nothing there.
FILM_MM = 0.3
# An outlet that frees less than this share of its pool is not worth drilling.
LEAST_FREED = 0.5
# Ways tried exactly before a pool counts as out of a hole's reach.
MOST_TRIED = 40
# Two mouths are this many diameters apart at least.
APART = 2.5
# A hole is kept where its ball still fits but for this.
FITS_MM = 0.02
# Filled floors lie this much above the channel's, so that they meet it from above.
RAISED_MM = 0.1


@dataclass(frozen=True, eq=False)
class Hole:
    """A channel and what it is for;  cavity : index of the cavity it opens."""

    role: Role
    channel: Channel
    cavity: int


@dataclass(frozen=True, eq=False)
class Drained:
    """Cavities with what cannot drain filled, and the holes that open them.

    cavities : positive solids, largest first;  holes : outlets first, cavity by cavity.
    filled_mm3 : what was filled of the cavities that are left.
    closed_mm3 : volumes of the cavities that no hole of this size opens, filled whole.
    """

    cavities: tuple[Manifold, ...]
    holes: tuple[Hole, ...]
    filled_mm3: float
    closed_mm3: tuple[float, ...]


def drained(
    outside: Manifold,
    cavities: Sequence[Manifold],
    *,
    diameter_mm: float,
    count: int,
    wall_mm: float,
    min_feature_mm: float,
    known: Sequence[Hole] = (),
) -> Drained:
    """Drain the cavities of a part.

    Parameters
    ----------
    outside : the part without its cavities, on the plate.
    diameter_mm : of the holes;  count : holes for each cavity, at least.  With two and more one of
        them is a vent, the rest are outlets; pools beyond those get outlets of their own.
    known : holes of a part like this one, kept where they still fit.
    """
    from manifold3d import Manifold, OpType

    if not cavities:
        return Drained((), (), 0.0, ())
    void = Manifold.batch_boolean(list(cavities), OpType.Add)
    driller = Driller(outside, void, diameter_mm, wall_mm)
    driller.keep(known)
    driller.drill_outlets()
    driller.drill_vents(count)
    left = void - driller.filling()
    return _assigned(driller.drilled, cavities_of(left, min_feature_mm), cavities)


class Driller:
    """Finds one hole after another in a part; ``drilled`` are those found so far."""

    def __init__(
        self, outside: Manifold, void: Manifold, diameter_mm: float, wall_mm: float
    ) -> None:
        self.diameter_mm = diameter_mm
        self.radius_mm = diameter_mm / 2
        self.wall_mm = wall_mm
        self.clearance_mm = wall_mm / 2
        self.space = space_of(outside, void, diameter_mm)
        self.pools = Pools(self.space.dexels, self.space.grid)
        self.outside = Surface.of(outside)
        self.void = Surface.of(void)
        self.drilled: list[tuple[Role, Channel]] = []
        self._outlets: list[Outlet] = []

    def keep(self, holes: Sequence[Hole]) -> None:
        """Take over holes whose inner ball still fits in the void."""
        for hole in holes:
            centre = hole.channel.inner_mm[None]
            if self.void.depth_mm(centre)[0] < self.radius_mm - FITS_MM:
                continue
            self.drilled.append((hole.role, hole.channel))
            if hole.role == "outlet":
                self._outlets.append(self._outlet(hole.channel))

    def drill_outlets(self) -> None:
        """An outlet for every pool that is worth one, the largest first."""
        beyond_reach = np.zeros(0, dtype=np.int64)
        while True:
            standing = self.pools.standing_mm(self.pools.levels(self._outlets, slope=0.0))
            standing = np.maximum(standing - FILM_MM, 0.0)
            pool, volume_mm3 = self.pools.largest(standing, beyond_reach)
            if volume_mm3 < LEAST_POOL_MM3:
                return
            channel = self._outlet_of(pool, volume_mm3)
            if channel is None:
                beyond_reach = np.concatenate([beyond_reach, pool])
                continue
            self.drilled.append(("outlet", channel))
            self._outlets.append(self._outlet(channel))

    def drill_vents(self, count: int) -> None:
        """A vent for every cavity with an outlet, and more up to ``count`` holes in each."""
        group = self.pools.components()
        drains = [group[outlet.dexels[0]] for outlet in self._outlets]
        vents = [
            group[self._outlet(channel).dexels[:1]]
            for role, channel in self.drilled
            if role == "vent"
        ]
        for number in sorted(set(drains)):
            have = drains.count(number)
            vented = sum(number in where for where in vents)
            for _ in range(max(count - have, min(count - 1, 1)) - vented):
                channel = self._vent_of(np.flatnonzero(group == number))
                if channel is None:
                    break
                self.drilled.append(("vent", channel))

    def filling(self) -> Manifold:
        """What has to be filled, so that all that is left drains."""
        levels = self.pools.levels(self._outlets)
        return filling(self.pools, levels, self.space.void)

    def _outlet_of(self, pool: Int, volume_mm3: float) -> Channel | None:
        balls = balls_at_rest(self.space, self.void, pool, self.radius_mm)
        if not len(balls):
            return None
        below = self._held_below(pool, balls[:, 2] - self.radius_mm + RAISED_MM)
        worth = volume_mm3 - below >= LEAST_FREED * volume_mm3
        balls, below = balls[worth], below[worth]
        return self._first_clean(self._ways(balls, FILLED_MM * below, "outlet"))

    def _vent_of(self, cavity: Int) -> Channel | None:
        balls = balls_at_rest(self.space, self.void, cavity, self.radius_mm, top=True)
        if not len(balls):
            return None
        top = float(self.pools.dexels.high_mm[cavity].max())
        mouths = np.array([channel.centre_mm for _, channel in self.drilled])
        away = np.linalg.norm(balls[:, None] - mouths, axis=2).min(axis=1)
        extra = DEPTH_MM * (top - balls[:, 2]) - AWAY_MM * away
        return self._first_clean(self._ways(balls, extra, "vent"))

    def _ways(self, balls: Float, extra_mm: Float, role: Role) -> tuple[Candidate, ...]:
        return ways_out(
            self.space, balls, extra_mm, self.radius_mm, self.wall_mm, self.clearance_mm, role
        )

    def _first_clean(self, ways: Sequence[Candidate]) -> Channel | None:
        """The cheapest way that is clean by exact measure, apart from the holes there are."""
        tried = 0
        for way in ways:
            if tried == MOST_TRIED:
                break
            if not self._apart(way.mouth_mm):
                continue
            tried += 1
            channel = channel_along(
                way, self.outside, self.void, self.diameter_mm, self.wall_mm, self.clearance_mm
            )
            if channel is not None and self._apart(channel.centre_mm):
                return channel
        return None

    def _apart(self, mouth_mm: Float) -> bool:
        least = APART * self.diameter_mm
        return all(
            float(np.linalg.norm(mouth_mm - other.centre_mm)) >= least for _, other in self.drilled
        )

    def _outlet(self, channel: Channel) -> Outlet:
        """The dexels over a channel's inner ball, which empty to just above its floor."""
        dexels, grid = self.pools.dexels, self.space.grid
        i, j = np.divmod(dexels.column, grid.shape[1])
        x, y = (grid.origin_mm[a] + grid.pitch_mm * k for a, k in ((0, i), (1, j)))
        near = np.hypot(x - channel.inner_mm[0], y - channel.inner_mm[1]) <= max(
            0.6 * self.radius_mm, 0.75 * grid.pitch_mm
        )
        z = float(channel.inner_mm[2])
        near &= (dexels.low_mm < z) & (dexels.high_mm > z)
        return Outlet(np.flatnonzero(near), channel.floor_mm + RAISED_MM)

    def _held_below(self, pool: Int, levels_mm: Float) -> Float:
        """(n,) mm³ of a pool that lie below each of these levels."""
        low, high = self.pools.dexels.low_mm[pool], self.pools.dexels.high_mm[pool]
        deep = np.clip(levels_mm[:, None] - low, 0, high - low)
        result: Float = deep.sum(axis=1) * self.pools.area_mm2
        return result


def _assigned(
    drilled: Sequence[tuple[Role, Channel]],
    pieces: Sequence[Manifold],
    before: Sequence[Manifold],
) -> Drained:
    """The pieces that a hole opens, with their holes."""
    solids = [bored(channel) for _, channel in drilled]
    kept: list[Manifold] = []
    holes: list[Hole] = []
    used: set[int] = set()
    for piece in pieces:
        opening = [
            k for k, solid in enumerate(solids) if k not in used and (solid ^ piece).volume() > 0
        ]
        if not any(drilled[k][0] == "outlet" for k in opening):
            continue
        used.update(opening)
        holes += [Hole(*drilled[k], len(kept)) for k in opening]
        kept.append(piece)
    closed = [
        float(cavity.volume())
        for cavity in before
        if not any((cavity ^ piece).volume() > 0 for piece in kept)
    ]
    total = sum(cavity.volume() for cavity in before)
    filled = total - sum(closed) - sum(piece.volume() for piece in kept)
    return Drained(tuple(kept), tuple(holes), float(filled), tuple(closed))
