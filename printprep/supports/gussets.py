"""Gussets: widen capitals toward points that lie just out of their reach.

What the rule flags beside a capital lies a few hundredths of a millimetre out of its reach: a
groove between its flank and a slope closes too early.  A funnel that begins a little lower on the
capital's column carries it.  Of that funnel only ribs are built, as thick as the column, to each
point of the patch, and their hull.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.solids import BEYOND_MM, Frustum, section

if TYPE_CHECKING:
    from collections.abc import Sequence

    from printprep.arrays import Float
    from printprep.supports.capitals import Capitals
    from printprep.supports.column_forest import Forest
    from printprep.supports.member_sizes import MemberSizes

# A gusset reaches no farther out of its capital: less than a line's width needs no own column.
MOST_OUT_MM = 0.4
# A gusset begins at most so far below the capital's node; the search goes down in steps.
MOST_DROP_MM = 2.0
STEP_MM = 0.1
# It reaches so far beyond each point of a patch.
MARGIN_MM = 0.1
_STEPS = 6


def gussets(
    points: Float, capitals: Capitals, forest: Forest, members: MemberSizes
) -> tuple[list[Frustum], Float]:
    """Build gussets for the points that capitals almost carry.

    points : (n, 3) mm;  forest : its first places are the capitals' nodes, in the same order.
    Returns the gussets, and the points (k, 3) mm that are left.
    """
    nodes = capitals.node_mm
    away = points[:, None] - nodes[None]
    out = np.hypot(away[..., 0], away[..., 1]) - members.radius_mm - away[..., 2] * members.tan
    out[(away[..., 2] < 0) | (away[..., 2] > capitals.top_mm - nodes[:, 2] + BEYOND_MM)] = np.inf
    found: list[Frustum] = []
    left = np.ones(len(points), dtype=bool)
    for capital in np.argsort(out.min(axis=0), kind="stable").tolist():
        own = left & (out[:, capital] <= MOST_OUT_MM)
        gusset = _gusset(points[own], capital, forest, members) if own.any() else None
        if gusset is not None:
            found.append(gusset)
            left &= ~own
    return found, points[left]


def _gusset(points: Float, node: int, forest: Forest, members: MemberSizes) -> Frustum | None:
    """The gusset from the highest place under a node that reaches all points (k, 3) mm, or None."""
    for place, way, above_mm in _below(node, forest):
        half = float(members.across_mm(np.array(above_mm)))
        away = points - place
        d = np.hypot(away[:, 0], away[:, 1])
        if (d + MARGIN_MM <= half + away[:, 2] * members.tan).all():
            ribs = [_rib(vector, half) for vector in away]
            return Frustum(place + np.concatenate([section(way, half), *ribs]), 2 * half)
    return None


def _rib(away: Float, half_mm: float) -> Float:
    """(n, 3) mm, corners of the upper end of a round rib from the origin that just covers a point.

    away : (3,) mm, that point.
    """
    d, rise = float(np.hypot(away[0], away[1])), float(away[2])
    out = 0.0
    for _ in range(_STEPS):
        out = max(d + MARGIN_MM - half_mm * float(np.hypot(1.0, out / rise)), 0.0)
    along = away[:2] / d if d > 0 else np.zeros(2)
    way = np.array([*(out * along), rise])
    end = way + section(way, half_mm)
    return np.concatenate([end, end + np.array([0.0, 0.0, BEYOND_MM])])


def _below(index: int, forest: Forest) -> Sequence[tuple[Float, Float, float]]:
    """Places (3,) mm down the axes from a node, with the column's way (3,) and the length above."""
    found = []
    left = MOST_DROP_MM
    while left > 0 and forest.down[index] >= 0:
        start, end = forest.place(index), forest.place(forest.down[index])
        way = end - start
        fall = -float(way[2])
        if fall > 0:
            length = float(np.linalg.norm(way))
            for drop in np.arange(STEP_MM, min(fall, left), STEP_MM).tolist():
                share = drop / fall
                found.append((start + share * way, way, forest.above_mm[index] + share * length))
            left -= fall
        index = forest.down[index]
    return found
