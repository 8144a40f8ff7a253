"""Sets of ceiling samples, each carried by one funnel: the funnel's node and its volume.

All sets are computed together: their samples lie one set after the other, (m, 3), and ``start``
(s,) holds where each set begins.  Notation as in capitals.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.supports.member_sizes import MemberSizes

# The overlap that neighbouring funnels need between samples.
OVERLAP_MM = 0.1
# A funnel carries nothing farther from its axis, nor higher above its node.
REACH_MM = 3.6
RISE_MM = 5.0
# The share of a whole funnel that counts beside what it fills under its samples: some of it reaches
# beyond them, into the cavity or into funnels beside it.
BESIDE = 0.3


@dataclass(frozen=True, eq=False)
class SetCover:
    """Sets of samples.

    points_mm : (m, 3) mm, set after set;  start : (s,) first point of each set;  owner : (m,) the
    set of each point.
    """

    points_mm: Float
    start: Int
    owner: Int

    @staticmethod
    def of(points: Float, sizes: Int) -> SetCover:
        """Sets from points (m, 3) mm, set after set, and their sizes (s,), none of them 0."""
        return SetCover(points, np.cumsum(sizes) - sizes, np.repeat(np.arange(len(sizes)), sizes))

    @property
    def tops_mm(self) -> Float:
        """(s,) mm, the highest point of each set."""
        result: Float = np.maximum.reduceat(self.points_mm[:, 2], self.start)
        return result

    def farthest_mm(self, nodes: Float) -> Float:
        """(s,) mm, from each node (s, 3) mm to the farthest point of its set, seen from above."""
        x, y = np.ascontiguousarray(self.points_mm[:, :2].T)
        result: Float = np.maximum.reduceat(self._away(x, y, nodes), self.start)
        return result

    def highest(self, places: Float, members: MemberSizes, steps: int) -> Float:
        """(s, 3) mm, the highest nodes found that carry all of their sets.

        The search starts at places (s, 2) mm and steps toward the sample that keeps the node
        lowest, in shrinking steps.  (Bădoiu and Clarkson 2003 find the centre of a smallest
        enclosing ball so.)
        """
        x, y, z = np.ascontiguousarray(self.points_mm.T)
        place, slack = places.copy(), members.radius_mm - OVERLAP_MM
        best = np.column_stack([place, np.full(len(place), -np.inf)])
        number = np.arange(len(z))
        for step in range(steps):
            d = self._away(x, y, place)
            limit = z - np.maximum(d - slack, 0.0) / members.tan
            least = np.minimum.reduceat(limit, self.start)
            better = least > best[:, 2]
            best[better] = np.column_stack([place, least])[better]
            holds = np.where(limit == least.take(self.owner), number, len(number))
            worst = np.minimum.reduceat(holds, self.start)
            place += (self.points_mm[worst, :2] - place) / (step + 2)
        return best

    def _away(self, x: Float, y: Float, places: Float) -> Float:
        """(m,) mm, from points x (m,), y (m,) to the places (s, 2) mm of their sets."""
        dx, dy = x - places[:, 0].take(self.owner), y - places[:, 1].take(self.owner)
        dx *= dx
        dy *= dy
        dx += dy
        return np.sqrt(dx, out=dx)

    def volume_mm3(self, nodes: Float, members: MemberSizes, area_mm2: float) -> Float:
        """(s,) mm³, what funnels on nodes (s, 3) mm fill under their sets.

        Each sample stands for ``area_mm2``.  inf where a funnel carries farther or higher than it
        may.
        """
        x, y, z = np.ascontiguousarray(self.points_mm.T)
        d, above = self._away(x, y, nodes[:, :2]), z - nodes[:, 2].take(self.owner)
        thick = above - np.maximum(d - members.radius_mm, 0.0) / members.tan
        beyond = (d > REACH_MM) | (above > RISE_MM)
        rise = np.maximum(self.tops_mm - nodes[:, 2], 0.0)
        narrow, wide = members.radius_mm, members.radius_mm + rise * members.tan
        whole = np.pi / 3 * rise * (narrow**2 + narrow * wide + wide**2)
        under = area_mm2 * np.add.reduceat(np.maximum(thick, 0.0), self.start)
        result: Float = under + BESIDE * whole
        result[np.logical_or.reduceat(beyond, self.start)] = np.inf
        return result
