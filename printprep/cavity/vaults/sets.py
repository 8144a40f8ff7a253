"""Samples in sets, each carried by one funnel: where it must stand, and what it takes.

All sets are looked at together: their samples lie one set after the other, (m, 3), and ``start``
(s,) says where each begins.  Notation as in capitals.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.cavity.vaults.members import Members
    from printprep.types import Float, Int

# What neighbouring funnels must overlap between samples.
OVERLAP_MM = 0.1
# A funnel carries nothing farther from its axis, nor higher above its node.
REACH_MM = 3.6
RISE_MM = 5.0
# What of a whole funnel counts beside what it fills under its samples: some of it stands out of
# them, in the room or in funnels beside it.
BESIDE = 0.3


@dataclass(frozen=True, eq=False)
class Sets:
    """points_mm : (m, 3);  start : (s,);  owner : (m,) the set of each point."""

    points_mm: Float
    start: Int
    owner: Int

    @staticmethod
    def of(points: Float, sizes: Int) -> Sets:
        """Points set after set, as many as ``sizes`` (s,) says, none of which is 0."""
        return Sets(points, np.cumsum(sizes) - sizes, np.repeat(np.arange(len(sizes)), sizes))

    @property
    def tops_mm(self) -> Float:
        """(s,) the highest point of each."""
        result: Float = np.maximum.reduceat(self.points_mm[:, 2], self.start)
        return result

    def highest(self, places: Float, members: Members, steps: int) -> Float:
        """(s, 3) the highest nodes found that carry all of their sets, sought from places (s, 2).

        By walking toward the sample that holds the node lowest, in shrinking steps.  (The centre of
        a smallest enclosing ball is found so: Bădoiu and Clarkson 2003.)
        """
        place, slack = places.copy(), members.radius_mm - OVERLAP_MM
        best = np.column_stack([place, np.full(len(place), -np.inf)])
        number = np.arange(len(self.points_mm))
        for step in range(steps):
            away = self.points_mm[:, :2] - place[self.owner]
            d = np.hypot(away[:, 0], away[:, 1])
            limit = self.points_mm[:, 2] - np.maximum(d - slack, 0.0) / members.tan
            least = np.minimum.reduceat(limit, self.start)
            better = least > best[:, 2]
            best[better] = np.column_stack([place, least])[better]
            holds = np.where(limit == least[self.owner], number, len(number))
            worst = np.minimum.reduceat(holds, self.start)
            place = place + away[worst] / (step + 2)
        return best

    def volume_mm3(self, nodes: Float, members: Members, area_mm2: float) -> Float:
        """(s,) what funnels on nodes (s, 3) fill under their sets, a sample standing for an area.

        inf where one would carry farther or higher than a funnel may.
        """
        away = self.points_mm - nodes[self.owner]
        d = np.hypot(away[:, 0], away[:, 1])
        thick = away[:, 2] - np.maximum(d - members.radius_mm, 0.0) / members.tan
        beyond = (d > REACH_MM) | (away[:, 2] > RISE_MM)
        rise = np.maximum(self.tops_mm - nodes[:, 2], 0.0)
        narrow, wide = members.radius_mm, members.radius_mm + rise * members.tan
        whole = np.pi / 3 * rise * (narrow**2 + narrow * wide + wide**2)
        under = area_mm2 * np.add.reduceat(np.maximum(thick, 0.0), self.start)
        result: Float = under + BESIDE * whole
        result[np.logical_or.reduceat(beyond, self.start)] = np.inf
        return result
