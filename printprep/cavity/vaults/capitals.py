"""Capitals: funnels, round discs that widen upward at θ, that together touch every ceiling sample.

Notation: node n the middle of a funnel's lower disc, r its radius, q a sample, d = |q − n| seen
from above, s = 0.06 mm what neighbouring funnels must overlap between samples.  A funnel carries q
where d ≤ r + (q_z − n_z) tan θ − s; over q it is q_z − n_z − max(0, d − r) / tan θ thick.

Weighted set cover by the greedy rule (Chvátal 1979): the funnel with the most newly carried area
for its cost comes next, cost being a fixed volume for the column and what it fills beyond what
others fill already.  (Without that charge for overlap the result is 2.5 times as heavy.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.cavity.vaults.members import Members
    from printprep.types import Float, Int

OVERLAP_MM = 0.06
# What a column is taken to cost before it is known; the result is flat in it.
COLUMN_MM3 = 8.0
CANDIDATE_STEP_MM = 0.7
# Nodes lie so far under a sample.
LOWERED_MM = (0.0, 0.4, 0.9, 1.4, 2.0, 2.8, 3.6)
# A funnel carries nothing farther from its axis, nor higher above its node.
REACH_MM = 3.6
RISE_MM = 5.0
TIGHTENINGS = 3
# Candidates valued together.
_TOGETHER = 64


@dataclass(frozen=True, eq=False)
class Capitals:
    """node_mm : (k, 3) middles of the lower discs;  top_mm : (k,) height to which each widens."""

    node_mm: Float
    top_mm: Float


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Which candidate carries which samples: ``sample[start[c]:start[c + 1]]``, and how thick."""

    start: Int
    sample: Int
    thick_mm: Float


def cover(samples: Float, members: Members, area_mm2: float) -> Capitals:
    """Capitals for all samples (n, 3), each of which stands for ``area_mm2`` of ceiling."""
    if len(samples) == 0:
        return Capitals(np.zeros((0, 3)), np.zeros(0))
    nodes = _candidates(samples)
    pairs = _pairs(nodes, samples, members)
    chosen = _greedy(pairs, len(samples), area_mm2)
    return _tightened(nodes[chosen], samples, members)


def _candidates(samples: Float) -> Float:
    """Samples on a coarser lattice, the lowest of each cell, at every depth."""
    cell = np.floor(samples / CANDIDATE_STEP_MM).astype(np.int64)
    order = np.lexsort((samples[:, 2], cell[:, 2], cell[:, 1], cell[:, 0]))
    _, first = np.unique(cell[order], axis=0, return_index=True)
    base = samples[order[first]]
    nodes = np.repeat(base, len(LOWERED_MM), axis=0)
    nodes[:, 2] -= np.tile(LOWERED_MM, len(base))
    return nodes


def _near(nodes: Float, samples: Float) -> tuple[Int, Int, Float]:
    """Every (node, sample) within reach, seen from above, sorted; and d."""
    from scipy.spatial import cKDTree

    found = cKDTree(nodes[:, :2]).sparse_distance_matrix(
        cKDTree(samples[:, :2]), REACH_MM, output_type="ndarray"
    )
    order = np.lexsort((found["j"], found["i"]))
    i, j = found["i"][order].astype(np.int64), found["j"][order].astype(np.int64)
    return i, j, found["v"][order]


def _pairs(nodes: Float, samples: Float, members: Members) -> _Pairs:
    depths = len(LOWERED_MM)
    base = nodes[::depths]  # lowered by nothing
    i, j, d = _near(base, samples)
    rise = samples[j, 2] - base[i, 2]
    kept = []
    for depth, lowered in enumerate(LOWERED_MM):
        up = rise + lowered
        carried = (
            (up >= 0) & (up <= RISE_MM) & (d <= members.radius_mm + up * members.tan - OVERLAP_MM)
        )
        at = np.flatnonzero(carried)
        thick = up[at] - np.maximum(0.0, d[at] - members.radius_mm) / members.tan
        kept.append((i[at] * depths + depth, j[at], thick))
    node, sample, thick = (np.concatenate(part) for part in zip(*kept, strict=True))
    order = np.argsort(node, kind="stable")
    start = np.searchsorted(node[order], np.arange(len(nodes) + 1))
    return _Pairs(start, sample[order], np.maximum(thick[order], 0.0))


def _greedy(pairs: _Pairs, count: int, area_mm2: float) -> Int:
    """Indices of candidates whose samples are all samples that any candidate carries.

    A value only falls while others are chosen, so an old one bounds it: those of the highest bounds
    are valued anew, together, until the best of them beats all other bounds.
    """
    missing, filled = np.ones(count), np.zeros(count)
    start, length = pairs.start, np.diff(pairs.start)
    fixed = COLUMN_MM3 / area_mm2

    def value(candidates: Int) -> Float:
        sizes = length[candidates]
        first = np.cumsum(sizes) - sizes
        run = np.arange(int(sizes.sum())) + np.repeat(start[candidates] - first, sizes)
        sample = pairs.sample[run]
        more = np.maximum(pairs.thick_mm[run] - filled[sample], 0.0)
        gained = np.add.reduceat(missing[sample], first)
        result: Float = gained / (fixed + np.add.reduceat(more, first))
        return result

    waiting = np.flatnonzero(length > 0)
    bound = value(waiting) if len(waiting) else np.zeros(0)
    chosen: list[int] = []
    while len(waiting):
        if len(waiting) > _TOGETHER:
            parted = np.argpartition(-bound, _TOGETHER)
            top, rest = np.sort(parted[:_TOGETHER]), float(bound[parted[_TOGETHER]])
        else:
            top, rest = np.arange(len(waiting)), 0.0
        bound[top] = value(waiting[top])
        while True:
            best = int(top[np.argmax(bound[top])])
            if bound[best] <= 0 or bound[best] < rest:
                break
            candidate = int(waiting[best])
            chosen.append(candidate)
            run = slice(start[candidate], start[candidate + 1])
            missing[pairs.sample[run]] = 0.0
            np.maximum.at(filled, pairs.sample[run], pairs.thick_mm[run])
            bound[top] = value(waiting[top])
        spent = bound[top] <= 0
        if spent.any():
            kept = np.ones(len(waiting), dtype=bool)
            kept[top[spent]] = False
            waiting, bound = waiting[kept], bound[kept]
    return np.array(chosen, dtype=np.int64)


def _tightened(nodes: Float, samples: Float, members: Members) -> Capitals:
    """Capitals without those that alone carry nothing, the rest where they sit highest."""
    nodes = nodes.copy()
    alive = np.ones(len(nodes), dtype=bool)
    own: list[Int] = []
    for _ in range(TIGHTENINGS):
        node, sample, d = _near(nodes, samples)
        rise = samples[sample, 2] - nodes[node, 2]
        inside = (
            (rise >= 0)
            & (rise <= RISE_MM)
            & (d <= members.radius_mm + rise * members.tan - OVERLAP_MM + 1e-9)
        )
        inside &= alive[node]
        node, sample = node[inside], sample[inside]
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
            nodes[index] = _highest(nodes[index], samples[alone], members)
            times[alone] += 1
            own[index] = alone
    kept = np.flatnonzero(alive)
    tops = [float(samples[own[index], 2].max()) for index in kept]
    return Capitals(nodes[kept], np.array(tops))


def _highest(node: Float, samples: Float, members: Members, steps: int = 12) -> Float:
    """The highest node that carries all of these samples, found by walking toward the worst.

    (The centre of a smallest enclosing ball is found so: Bădoiu and Clarkson 2003.)
    """
    best, place = node, node[:2].copy()
    slack = members.radius_mm - OVERLAP_MM
    for step in range(steps):
        away = samples[:, :2] - place
        d = np.sqrt((away**2).sum(axis=1))
        limit = samples[:, 2] - np.maximum(0.0, d - slack) / members.tan
        worst = int(np.argmin(limit))
        if limit[worst] > best[2]:
            best = np.array([place[0], place[1], limit[worst]])
        place = place + away[worst] / (step + 2)
    return best
