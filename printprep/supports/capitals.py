"""Capitals: funnels that widen upward at θ and together touch every ceiling sample.

Notation: node n the middle of a funnel's lower disc, r its radius, q a sample, d = |q − n| seen
from above, s = 0.1 mm the overlap that neighbouring funnels need between samples.  A funnel carries
q where d ≤ r + (q_z − n_z) tan θ − s; over q it is q_z − n_z − max(0, d − r) / tan θ thick.

ceiling_groups.py finds groups of samples that share a funnel.  Here funnels without a sample of
their own are dropped, and the others raised as high as their samples allow.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.ceiling_groups import Price, grouped_nodes
from printprep.supports.set_cover import OVERLAP_MM, REACH_MM, RISE_MM, SetCover

if TYPE_CHECKING:
    from collections.abc import Sequence

    from printprep.arrays import Float, Int
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

TIGHTENINGS = 2
# Steps of the search for the node of a funnel that is built.
_STEPS = 12


@dataclass(frozen=True, eq=False)
class Capitals:
    """Funnels under a ceiling.

    node_mm : (k, 3) mm, middles of the lower discs;  top_mm : (k,) mm, height to which each widens.
    """

    node_mm: Float
    top_mm: Float

    @staticmethod
    def none() -> Capitals:
        """No capitals."""
        return Capitals(np.zeros((0, 3)), np.zeros(0))


def cover(samples: Float, members: MemberSizes, area_mm2: float, lookup: InsideLookup) -> Capitals:
    """Find capitals that carry all samples.

    samples : (n, 3) mm, ceiling points that each stand for ``area_mm2``;  lookup : answers what is
    inside the hollowable volume.
    """
    if len(samples) == 0:
        return Capitals.none()
    nodes = grouped_nodes(samples, Price(members, area_mm2, lookup))
    # On jagged ceilings a group may grow wider than its funnel: each sample left gets its own.
    left = np.delete(samples, _carried(nodes, samples, members)[1], axis=0)
    return _tightened(np.concatenate([nodes, left]), samples, members)


def _tightened(nodes: Float, samples: Float, members: MemberSizes) -> Capitals:
    """Drop capitals without a sample of their own, and raise the others.

    nodes : (k, 3) mm;  samples : (n, 3) mm.
    """
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


def _carried(nodes: Float, samples: Float, members: MemberSizes) -> tuple[Int, Int]:
    """Every pair of a node and a sample it carries, as two arrays (p,) of indices, sorted.

    nodes : (k, 3) mm;  samples : (n, 3) mm.
    """
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


def _higher(nodes: Float, samples: Sequence[Float], members: MemberSizes) -> Float:
    """(k, 3) mm, the highest nodes found that carry all their samples, or the nodes given.

    nodes : (k, 3) mm;  samples : for each node, (n, 3) mm.
    """
    sets = SetCover.of(np.concatenate(samples), np.array([len(own) for own in samples]))
    found = sets.highest(nodes[:, :2], members, _STEPS)
    better = (found[:, 2] > nodes[:, 2]) & (sets.farthest_mm(found) <= REACH_MM)
    return np.where(better[:, None], found, nodes)
