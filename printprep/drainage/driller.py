"""The driller: finds outlets where liquid stands and vents where air must come in."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.balls import balls_in
from printprep.drainage.channel import Channel
from printprep.drainage.exact_channel import exact_channel
from printprep.drainage.fill_undrained import filling
from printprep.drainage.hole_candidates import AWAY_MM, DEPTH_MM, FILLED_MM, balls_at_rest, ways_out
from printprep.drainage.pools import Pools
from printprep.drainage.residual_pools import residual_pools
from printprep.drainage.voxelized_part import VoxelizedPart
from printprep.grid.distance import Surface
from printprep.mesh.shell_figures import joined, pieces

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int
    from printprep.drainage.hole_candidates import Candidate, Role

# A pool that holds less than this, or than this share of all cavities, is filled: a hole there
# spoils the surface for little.
LEAST_POOL_MM3 = 250.0
LEAST_POOL = 0.005
# Liquid that stands no higher than this does not count.
FILM_MM = 0.3
# An outlet that frees less than this share of its pool is not worth drilling.
LEAST_FREED = 0.5
# Heights above a pool's lowest place at which an outlet may begin, tried one after the other.
BANDS_MM = (4.0, 12.0, 30.0)
# Ways measured exactly before a pool counts as out of reach.
MOST_TRIED = 25
# Mouths are at least this many diameters apart.
APART = 2.5
# A known hole is kept where its ball overlaps the wall by no more than this.
FITS_MM = 0.1
# A ball this much smaller than the hole passes wherever liquid does on its way to the hole: in low
# cavities a full ball has no way to rise, and they fall apart into pools.
PASSES = 0.9
# Liquid runs where a ball of this share of a hole's width passes: narrower passages clog.
RUNS = 0.4
# The pitch of the columns on which drops are followed, as a share of the grid's pitch.
FINE = 0.5


@dataclass(frozen=True, eq=False)
class Hole:
    """A channel and its role;  cavity : index of the cavity it opens."""

    role: Role
    channel: Channel
    cavity: int


class Driller:
    """Finds one hole after another in a part; ``drilled`` holds those found so far."""

    def __init__(
        self,
        voxelized: VoxelizedPart,
        outside: Manifold,
        void: Manifold,
        diameter_mm: float,
        wall_mm: float,
    ) -> None:
        self.diameter_mm = diameter_mm
        self.radius_mm = diameter_mm / 2
        self.wall_mm = wall_mm
        self.clearance_mm = wall_mm / 2
        self.voxelized = voxelized
        self.outside = Surface.of(outside)
        self.void = Surface.of(void)
        self.rests = Pools(balls_in(voxelized, self.void, self.radius_mm), voxelized.grid)
        self.pools = Pools(balls_in(voxelized, self.void, PASSES * self.radius_mm), voxelized.grid)
        self._pool_of_rest = self.pools.holding(self.rests.dexels)
        self.drilled: list[tuple[Role, Channel]] = []

    def keep(self, holes: Sequence[Hole]) -> None:
        """Keep holes whose inner ball still fits in the void."""
        for hole in holes:
            clearance = self.void.depth_mm(hole.channel.inner_mm[None])[0]
            if clearance >= self.radius_mm - FITS_MM and len(self.pools.over(hole.channel)):
                self.drilled.append((hole.role, hole.channel))

    def drill_outlets(self) -> None:
        """Drill an outlet for every pool that is worth one, the largest first."""
        beyond_reach = np.zeros(0, dtype=np.int64)
        while True:
            outlets = self.pools.outlets(self._channels("outlet"))
            levels = self.pools.levels(outlets, slope=0.0)
            film = np.where(np.isfinite(levels), FILM_MM, 0.0)
            depth = np.maximum(self.pools.liquid_depth_mm(levels) - film, 0.0)
            pool, volume_mm3 = self.pools.largest(depth, beyond_reach)
            if volume_mm3 < max(LEAST_POOL_MM3, LEAST_POOL * float(self.pools.volume_mm3.sum())):
                return
            channel = self._outlet_of(pool, volume_mm3)
            if channel is None:
                beyond_reach = np.concatenate([beyond_reach, pool])
            else:
                self.drilled.append(("outlet", channel))

    def drill_vents(self, count_of: Callable[[float], int]) -> None:
        """Drill a vent for every cavity with an outlet, and more up to its count of holes."""
        reached = np.isfinite(self.pools.levels(self.pools.outlets(self._channels("outlet"))))
        bodies = [
            (role, int(self.pools.balls.body[self.pools.over(channel)[0]]))
            for role, channel in self.drilled
        ]
        for body in sorted({body for role, body in bodies if role == "outlet"}):
            outlets, vents = (bodies.count((role, body)) for role in ("outlet", "vent"))
            count = count_of(float(self.pools.volume_mm3[self.pools.balls.body == body].sum()))
            for _ in range(max(count - outlets, min(count - 1, 1)) - vents):
                channel = self._vent_of(np.flatnonzero(reached & (self.pools.balls.body == body)))
                if channel is None:
                    break
                self.drilled.append(("vent", channel))

    def left_of(self, void: Manifold, least_mm3: float = 0.0, crumb_mm3: float = 0.0) -> Manifold:
        """The void that drains: what balls do not leave is filled, then what drops do not leave.

        least_mm3 : pieces with less volume are no cavity and are left out;  crumb_mm3 : dents that
        hold less stay.
        """
        channels = self._channels("outlet")
        runs = balls_in(self.voxelized, self.void, RUNS * self.radius_mm)
        tops = np.maximum(
            self.pools.tops_mm(channels), Pools(runs, self.voxelized.grid).tops_mm(channels)
        )
        # Filling and wall nearly coincide: thousands of slivers are left between them.
        left = joined(pieces(void - filling(self.voxelized, tops), least_mm3))
        pitch_mm = FINE * self.voxelized.grid.pitch_mm
        return left - residual_pools(left, channels, pitch_mm, crumb_mm3)

    def _channels(self, role: Role) -> list[Channel]:
        return [channel for other, channel in self.drilled if other == role]

    def _outlet_of(self, pool: Int, volume_mm3: float) -> Channel | None:
        """The best outlet of a pool (k,) of dexels; farther up where none begins low."""
        rests = self._rests_in(pool)
        spare_mm = self.radius_mm - self.pools.balls.radius_mm
        for band_mm in self._bands(rests):
            balls = balls_at_rest(self.rests, rests, band_mm)
            below = self.pools.held_below_mm3(pool, balls[:, 2] - spare_mm)
            worth = volume_mm3 - below >= LEAST_FREED * volume_mm3
            ways = self._ways(balls[worth], FILLED_MM * below[worth], "outlet")
            channel = self._first_clean(ways)
            if channel is not None:
                return channel
        return None

    def _rests_in(self, pool: Int) -> Int:
        """Dexels (m,) of balls of the hole's full width that fit in a pool (k,)."""
        return np.flatnonzero(np.isin(self._pool_of_rest, pool))

    def _bands(self, rests: Int) -> list[tuple[float, float]]:
        """Bands of height, one on the other, that hold all balls at rest of the dexels (m,).

        Bands do not overlap: where a lower band gives no hole, its places are still the cheapest,
        and would be tried again.
        """
        if not len(rests):
            return []
        dexels = self.rests.dexels
        high = float(np.ptp([dexels.low_mm[rests].min(), dexels.high_mm[rests].max()]))
        return list(pairwise((0.0, *(band for band in BANDS_MM if band < high), high)))

    def _vent_of(self, cavity: Int) -> Channel | None:
        """The best vent of a cavity (k,) of dexels; farther down where none begins high."""
        top = float(self.pools.dexels.high_mm[cavity].max())
        rests = self._rests_in(cavity)
        mouths = np.array([channel.centre_mm for _, channel in self.drilled])
        bands = self._bands(rests)
        for band_mm in [(0.0, bands[-2][1]), bands[-1]] if len(bands) > 1 else bands:
            balls = balls_at_rest(self.rests, rests, band_mm, top=True)
            away = np.linalg.norm(balls[:, None] - mouths, axis=2).min(axis=1)
            extra = DEPTH_MM * (top - balls[:, 2]) - AWAY_MM * away
            channel = self._first_clean(self._ways(balls, extra, "vent"))
            if channel is not None:
                return channel
        return None

    def _ways(self, balls: Float, extra_mm: Float, role: Role) -> tuple[Candidate, ...]:
        """Ways out of balls (n, 3) mm that cost ``extra_mm`` (n,) by themselves."""
        return ways_out(
            self.voxelized, balls, extra_mm, self.radius_mm, self.wall_mm, self.clearance_mm, role
        )

    def _first_clean(self, ways: Sequence[Candidate]) -> Channel | None:
        """The cheapest way that is clean by exact measure and apart from the other holes."""
        failed: list[Candidate] = []
        for way in ways:
            if len(failed) == MOST_TRIED:
                break
            if not self._apart(way.mouth_mm) or any(way.like(other) for other in failed):
                continue
            channel = exact_channel(
                way, self.outside, self.void, self.diameter_mm, self.wall_mm, self.clearance_mm
            )
            if channel is not None and self._apart(channel.centre_mm):
                return channel
            failed.append(way)
        return None

    def _apart(self, mouth_mm: Float) -> bool:
        """Whether a mouth (3,) mm is far enough from all others."""
        least = APART * self.diameter_mm
        return all(
            float(np.linalg.norm(mouth_mm - other.centre_mm)) >= least for _, other in self.drilled
        )
