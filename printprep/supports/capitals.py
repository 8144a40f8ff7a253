"""Capitals: funnels, round discs that widen upward at θ, that together touch every ceiling sample.

Notation: node n the middle of a funnel's lower disc, r its radius, q a sample, d = |q − n| seen
from above, s = 0.1 mm what neighbouring funnels must overlap between samples.  A funnel carries q
where d ≤ r + (q_z − n_z) tan θ − s; over q it is q_z − n_z − max(0, d − r) / tan θ thick.

Patches of ceiling, each with a funnel of its own, are evened out, each sample going to the funnel
that reaches farthest beyond it, and merged in pairs where a common funnel saves volume: what a
funnel costs is what it fills, mostly under its samples, and its column, as far as that goes alone:
to the floor, or where the room is high to the next column that it meets.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.set_cover import OVERLAP_MM, REACH_MM, RISE_MM, SetCover

if TYPE_CHECKING:
    from collections.abc import Sequence

    from printprep.arrays import Float, Int
    from printprep.supports.dexels import Dexels
    from printprep.supports.members import Members

# What a column is taken to cost before it is known: this share of one that goes straight to the
# floor, but no more than until it meets another, and no less than what is worth a funnel.
COLUMN_SHARE = 0.8
MOST_COLUMN_MM3 = 5.0
LEAST_COLUMN_MM3 = 2.0
# Side of the patches to begin with.
PATCH_MM = 2.6
NEIGHBOURS = 6
ROUNDS = 4
EVENINGS = 2
TIGHTENINGS = 2
# Steps in search of a funnel's node: for groups, and for what is built.
_STEPS, _MORE_STEPS = 6, 12


@dataclass(frozen=True, eq=False)
class Capitals:
    """node_mm : (k, 3) middles of the lower discs;  top_mm : (k,) height to which each widens."""

    node_mm: Float
    top_mm: Float

    @staticmethod
    def none() -> Capitals:
        return Capitals(np.zeros((0, 3)), np.zeros(0))


@dataclass(frozen=True, eq=False)
class _Groups:
    """Sets of samples, (s, 3) the node of a funnel that carries each, and (s,) what it costs."""

    sets: SetCover
    node_mm: Float
    cost_mm3: Float

    @staticmethod
    def of(sets: SetCover, nodes: Float, price: _Price) -> _Groups:
        return _Groups(sets, nodes, price.mm3(sets, nodes))


@dataclass(frozen=True, eq=False)
class _Price:
    """What funnels and their columns cost in a room, a sample standing for an area of ceiling."""

    members: Members
    area_mm2: float
    hollowable_volume: Dexels

    def mm3(self, sets: SetCover, nodes: Float) -> Float:
        """(s,) for funnels on nodes (s, 3) and the columns under them."""
        section_mm2 = np.pi * self.members.radius_mm**2
        column = COLUMN_SHARE * section_mm2 * self.hollowable_volume.headroom_mm(nodes)
        column = np.clip(column, LEAST_COLUMN_MM3, MOST_COLUMN_MM3)
        result: Float = column + sets.volume_mm3(nodes, self.members, self.area_mm2)
        return result


def cover(samples: Float, members: Members, area_mm2: float, hollowable_volume: Dexels) -> Capitals:
    """Capitals for all samples (n, 3), each of which stands for ``area_mm2`` of ceiling."""
    if len(samples) == 0:
        return Capitals.none()
    nodes = _grouped(samples, _Price(members, area_mm2, hollowable_volume))
    # On jagged ceilings a group may grow wider than its funnel: what that leaves is carried singly.
    left = np.delete(samples, _carried(nodes, samples, members)[1], axis=0)
    return _tightened(np.concatenate([nodes, left]), samples, members)


def _grouped(samples: Float, price: _Price) -> Float:
    """(k, 3) nodes of funnels that carry all samples."""
    groups = _patches(samples, price)
    for _ in range(ROUNDS):
        groups = _evened(groups, price)
        fewer = _merged(groups, price)
        if fewer is None:
            return groups.node_mm
        groups = fewer
    return _evened(groups, price).node_mm


def _patches(samples: Float, price: _Price) -> _Groups:
    """Samples by the cell of space they lie in: rows of cells, every other shifted by a half."""
    cells = np.floor(samples / PATCH_MM).astype(np.int64)
    cells[:, 0] = np.floor(samples[:, 0] / PATCH_MM + cells[:, 1] % 2 / 2)
    label = np.unique(cells, axis=0, return_inverse=True)[1]
    sets = _by_label(samples, np.ravel(label))
    sizes = np.bincount(sets.owner)
    middles = np.add.reduceat(sets.points_mm[:, :2], sets.start) / sizes[:, None]
    return _Groups.of(sets, sets.highest(middles, price.members, _STEPS), price)


def _evened(groups: _Groups, price: _Price) -> _Groups:
    """Each sample to the funnel that reaches farthest beyond it, then each funnel anew (Lloyd
    1982): groups grow round, and of one size."""
    sets, nodes = groups.sets, groups.node_mm
    for _ in range(EVENINGS):
        used, label = np.unique(_farthest_reaching(sets, nodes, price.members), return_inverse=True)
        sets, before = _by_label(sets.points_mm, label), nodes[used]
        nodes = sets.highest(before[:, :2], price.members, _STEPS)
        nodes = np.where((before[:, 2] > nodes[:, 2])[:, None], before, nodes)
    return _Groups.of(sets, nodes, price)


def _farthest_reaching(sets: SetCover, nodes: Float, members: Members) -> Int:
    """(m,) the funnel for every sample, among those near it; its own where none carries it."""
    from scipy.spatial import cKDTree

    points, count = sets.points_mm, min(NEIGHBOURS, len(nodes))
    near = cKDTree(nodes).query(points, count)[1].reshape(len(points), count)
    away = points[:, None, :] - nodes[near]
    d = np.hypot(away[..., 0], away[..., 1])
    beyond = members.radius_mm - OVERLAP_MM + away[..., 2] * members.tan - d
    beyond[(away[..., 2] < 0) | (away[..., 2] > RISE_MM) | (d > REACH_MM)] = -np.inf
    best = beyond.argmax(axis=1)
    row = np.arange(len(points))
    result: Int = np.where(beyond[row, best] >= 0, near[row, best], sets.owner)
    return result


def _merged(groups: _Groups, price: _Price) -> _Groups | None:
    """Groups of which pairs became one where that saves volume, those first that save most."""
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
    return _Groups.of(_by_label(sets.points_mm, label[sets.owner]), kept, price)


def _by_label(points: Float, label: Int) -> SetCover:
    """Points (m, 3) in sets by their labels (m,), which leave no number out."""
    return SetCover.of(points[np.argsort(label, kind="stable")], np.bincount(label))


def _neighbours(nodes: Float, tops: Float) -> tuple[Int, Int]:
    """Pairs of funnels near each other, each once, the first before the second."""
    from scipy.spatial import cKDTree

    key = np.column_stack([nodes[:, :2], tops])
    count = min(NEIGHBOURS + 1, len(key))
    found = cKDTree(key).query(key, count)[1].reshape(len(key), count)
    pairs = np.stack([np.repeat(np.arange(len(key)), count), found.ravel()], axis=1)
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    return pairs[:, 0], pairs[:, 1]


def _joined(sets: SetCover, sizes: Int, one: Int, other: Int) -> tuple[Float, Int]:
    """The samples of pairs of sets, pair after pair, and how many each pair has."""
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
    """Indices of pairs that gain, the best first, none of which shares a funnel with another."""
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


def _tightened(nodes: Float, samples: Float, members: Members) -> Capitals:
    """Capitals without those that alone carry nothing, the rest where they sit highest."""
    nodes = nodes.copy()
    alive = np.ones(len(nodes), dtype=bool)
    own: list[Int] = []
    for _ in range(TIGHTENINGS):
        node, sample = _carried(nodes, samples, members)
        node, sample = node[alive[node]], sample[alive[node]]
        start = np.searchsorted(node, np.arange(len(nodes) + 1))
        times = np.bincount(sample, minlength=len(samples))
        own = [np.zeros(0, dtype=np.int64)] * len(nodes)
        for index in np.argsort(nodes[:, 2], kind="stable").tolist():
            carried = sample[start[index] : start[index + 1]]
            alone = carried[times[carried] == 1]
            times[carried] -= 1
            if len(alone) == 0:
                alive[index] = False
                continue
            times[alone] += 1
            own[index] = alone
        kept = np.flatnonzero(alive)
        nodes[kept] = _higher(nodes[kept], [samples[own[index]] for index in kept], members)
    tops = [float(samples[own[index], 2].max()) for index in kept]
    return Capitals(nodes[kept], np.array(tops))


def _carried(nodes: Float, samples: Float, members: Members) -> tuple[Int, Int]:
    """Every (node, sample) where the one carries the other, sorted."""
    from scipy.spatial import cKDTree

    found = cKDTree(nodes[:, :2]).sparse_distance_matrix(
        cKDTree(samples[:, :2]), REACH_MM, output_type="ndarray"
    )
    node, sample = found["i"].astype(np.int64), found["j"].astype(np.int64)
    rise = samples[sample, 2] - nodes[node, 2]
    kept = (rise >= 0) & (rise <= RISE_MM)
    kept &= found["v"] <= members.radius_mm + rise * members.tan - OVERLAP_MM + 1e-9
    node, sample = node[kept], sample[kept]
    order = np.lexsort((sample, node))
    return node[order], sample[order]


def _higher(nodes: Float, samples: Sequence[Float], members: Members) -> Float:
    """(k, 3) the highest nodes found that carry all of their samples, or those they have."""
    sets = SetCover.of(np.concatenate(samples), np.array([len(own) for own in samples]))
    found = sets.highest(nodes[:, :2], members, _MORE_STEPS)
    better = (found[:, 2] > nodes[:, 2]) & (sets.farthest_mm(found) <= REACH_MM)
    return np.where(better[:, None], found, nodes)
