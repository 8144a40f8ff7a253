"""Group ceiling samples so that each group shares one funnel, at the least cost in volume.

Notation as in capitals.py.  Patches of ceiling, each with a funnel of its own, change in rounds.
First each sample goes to the funnel that reaches farthest beyond it.  Then pairs of groups merge
where a common funnel saves volume.  A funnel costs what it fills, mostly under its samples, and its
column, as far as that stands alone: to the floor, or in a high hollowable volume to the next column
that it meets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.set_cover import OVERLAP_MM, REACH_MM, RISE_MM, SetCover

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

# The assumed cost of a column that is not known yet: this share of one straight to the floor, at
# most that of the length until it meets another column, at least that of the length that makes a
# funnel worthwhile.
COLUMN_SHARE = 0.8
MOST_COLUMN_MM = 4.4
LEAST_COLUMN_MM = 1.8
# Side of the first patches.
PATCH_MM = 2.6
NEIGHBOURS = 6
ROUNDS = 4
EVENINGS = 2
# Steps of the search for a group's node.
_STEPS = 6


@dataclass(frozen=True, eq=False)
class Groups:
    """Groups of samples, each with its funnel.

    sets : the samples of each group;  node_mm : (s, 3) mm, the funnels' nodes;  cost_mm3 : (s,).
    """

    sets: SetCover
    node_mm: Float
    cost_mm3: Float

    @staticmethod
    def of(sets: SetCover, nodes: Float, price: Price) -> Groups:
        """Groups with funnels on nodes (s, 3) mm, priced."""
        return Groups(sets, nodes, price.mm3(sets, nodes))


@dataclass(frozen=True, eq=False)
class Price:
    """The cost of funnels and their columns, in volume.

    area_mm2 : ceiling that each sample stands for;  lookup : of the hollowable volume.
    """

    members: MemberSizes
    area_mm2: float
    lookup: InsideLookup

    def mm3(self, sets: SetCover, nodes: Float) -> Float:
        """(s,) mm³, funnels on nodes (s, 3) mm and the columns under them."""
        length = COLUMN_SHARE * self.lookup.headroom_mm(nodes)
        length = np.clip(length, LEAST_COLUMN_MM, MOST_COLUMN_MM)
        funnels = sets.volume_mm3(nodes, self.members, self.area_mm2)
        result: Float = self.members.cost_mm2 * length + funnels
        return result


def grouped_nodes(samples: Float, price: Price) -> Float:
    """(k, 3) mm, nodes of funnels that carry almost all samples (n, 3) mm."""
    groups = _patches(samples, price)
    for _ in range(ROUNDS):
        groups = _evened(groups, price)
        fewer = _merged(groups, price)
        if fewer is None:
            return groups.node_mm
        groups = fewer
    return _evened(groups, price).node_mm


def _patches(samples: Float, price: Price) -> Groups:
    """Group samples (n, 3) mm by cubic cells in rows, every other row shifted by half a cell."""
    cells = np.floor(samples / PATCH_MM).astype(np.int64)
    cells[:, 0] = np.floor(samples[:, 0] / PATCH_MM + cells[:, 1] % 2 / 2)
    label = np.unique(cells, axis=0, return_inverse=True)[1]
    sets = _by_label(samples, np.ravel(label))
    sizes = np.bincount(sets.owner)
    middles = np.add.reduceat(sets.points_mm[:, :2], sets.start) / sizes[:, None]
    return Groups.of(sets, sets.highest(middles, price.members, _STEPS), price)


def _evened(groups: Groups, price: Price) -> Groups:
    """Give each sample to the funnel that reaches farthest beyond it, then find each funnel anew.

    (Lloyd 1982.)  Groups become round and equal in size.
    """
    sets, nodes = groups.sets, groups.node_mm
    for _ in range(EVENINGS):
        used, label = np.unique(_farthest_reaching(sets, nodes, price.members), return_inverse=True)
        sets, before = _by_label(sets.points_mm, label), nodes[used]
        nodes = sets.highest(before[:, :2], price.members, _STEPS)
        nodes = np.where((before[:, 2] > nodes[:, 2])[:, None], before, nodes)
    return Groups.of(sets, nodes, price)


def _farthest_reaching(sets: SetCover, nodes: Float, members: MemberSizes) -> Int:
    """(m,) the funnel that reaches farthest beyond each sample, its own where none carries it.

    nodes : (s, 3) mm, of the funnels; those near a sample are tried.
    """
    from scipy.spatial import cKDTree

    points, count = sets.points_mm, min(NEIGHBOURS, len(nodes))
    near = cKDTree(nodes).query(points, count, workers=-1)[1].reshape(len(points), count)
    away = points[:, None, :] - nodes[near]
    d = np.hypot(away[..., 0], away[..., 1])
    beyond = members.radius_mm - OVERLAP_MM + away[..., 2] * members.tan - d
    beyond[(away[..., 2] < 0) | (away[..., 2] > RISE_MM) | (d > REACH_MM)] = -np.inf
    best = beyond.argmax(axis=1)
    row = np.arange(len(points))
    result: Int = np.where(beyond[row, best] >= 0, near[row, best], sets.owner)
    return result


def _merged(groups: Groups, price: Price) -> Groups | None:
    """Merge pairs of groups where that saves volume, most first; None when no merge does."""
    sets, nodes, cost = groups.sets, groups.node_mm.copy(), groups.cost_mm3
    sizes = np.bincount(sets.owner)
    one, other = _neighbours(nodes, sets.tops_mm)
    joint = SetCover.of(*_joined(sets, sizes, one, other))
    share = (sizes[one] / (sizes[one] + sizes[other]))[:, None]
    between = share * nodes[one, :2] + (1 - share) * nodes[other, :2]
    common = joint.highest(between, price.members, _STEPS)
    together = price.mm3(joint, common)
    apart = cost[one] + cost[other]
    gain = np.subtract(apart, together, out=np.zeros_like(apart), where=np.isfinite(together))
    pairs = _matched(one, other, gain)
    if not len(pairs):
        return None
    one, other = one[pairs], other[pairs]
    nodes[one] = common[pairs]
    into = np.arange(len(nodes))
    into[other] = one
    label = np.cumsum(into == np.arange(len(nodes)))[into] - 1
    kept = np.delete(nodes, other, axis=0)
    return Groups.of(_by_label(sets.points_mm, label[sets.owner]), kept, price)


def _by_label(points: Float, label: Int) -> SetCover:
    """Points (m, 3) mm in sets by their labels (m,); no number from 0 up is left out."""
    return SetCover.of(points[np.argsort(label, kind="stable")], np.bincount(label))


def _neighbours(nodes: Float, tops: Float) -> tuple[Int, Int]:
    """Pairs of nearby funnels as two arrays (p,) of indices, each pair once, the smaller first.

    nodes : (s, 3) mm;  tops : (s,) mm, the highest sample of each.
    """
    from scipy.spatial import cKDTree

    key = np.column_stack([nodes[:, :2], tops])
    count = min(NEIGHBOURS + 1, len(key))
    found = cKDTree(key).query(key, count, workers=-1)[1].reshape(len(key), count)
    pairs = np.stack([np.repeat(np.arange(len(key)), count), found.ravel()], axis=1)
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    return pairs[:, 0], pairs[:, 1]


def _joined(sets: SetCover, sizes: Int, one: Int, other: Int) -> tuple[Float, Int]:
    """Join the samples of pairs of sets.

    sizes : (s,) samples of each set;  one, other : (p,) indices of sets.
    Returns the samples (m, 3) mm, pair after pair, and (p,) how many each pair has.
    """
    total = sizes[one] + sizes[other]
    place = np.arange(int(total.sum())) - np.repeat(np.cumsum(total) - total, total)
    size = np.repeat(sizes[one], total)
    index = np.where(
        place < size,
        np.repeat(sets.start[one], total) + place,
        np.repeat(sets.start[other], total) + place - size,
    )
    return sets.points_mm[index], total


def _matched(one: Int, other: Int, gain: Float) -> Int:
    """(q,) indices of pairs that gain, the best first, no two with a common funnel.

    one, other : (p,) indices of funnels;  gain : (p,) mm³.
    """
    taken: set[int] = set()
    pairs = []
    for pair in np.argsort(-gain, kind="stable").tolist():
        if not gain[pair] > 0:
            break
        ends = {int(one[pair]), int(other[pair])}
        if taken.isdisjoint(ends):
            taken |= ends
            pairs.append(pair)
    return np.array(pairs, dtype=np.int64)
