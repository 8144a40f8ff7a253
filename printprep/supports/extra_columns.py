"""Extra columns: small funnels, each on a column from the nearest shell or vault."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.capitals import cover
from printprep.supports.ceiling import SPACING_MM
from printprep.supports.column_feet import STEP_MM, nearest_feet, set_feet
from printprep.supports.column_forest import Axes, Forest
from printprep.supports.columns import FOOT_MM
from printprep.supports.solids import Frustum, columns, funnels, section

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

# A column that leans on an axis stands out of it only after so many points of the axis.
LEAVE_STEPS = 3


def extra_columns(
    lookup: InsideLookup, points: Float, members: MemberSizes, axes: Axes
) -> tuple[list[Frustum], list[Frustum]]:
    """Build funnels under points of ceiling, and a column for each.

    points : (n, 3) mm.  Each column stands on the nearest shell or vault, or leans on a nearer
    axis, as thick as the column it enters.
    """
    members = replace(members, lean_deg=members.theta_deg)
    capitals = cover(points, members, SPACING_MM**2, lookup)
    nodes = capitals.node_mm
    deepest = float(nodes[:, 2].max()) - lookup.floor_mm + STEP_MM
    price, feet = nearest_feet(nodes, np.zeros(len(nodes)), lookup, members, deepest)
    forest = Forest()
    leaning = []
    for node, foot, cost in zip(nodes, feet, price.tolist(), strict=True):
        column = _on_axis(node, cost, axes, members)
        if column is None:
            forest.stand(forest.plant(node), foot)
        else:
            leaning.append(column)
    set_feet(forest, lookup, members)
    return funnels(capitals, members), columns(forest, members) + leaning


def _on_axis(node: Float, cost_mm: float, axes: Axes, members: MemberSizes) -> Frustum | None:
    """The column from a node (3,) mm to the nearest axis, or None where ``cost_mm`` is shorter."""
    fall = node[2] - axes.place_mm[:, 2]
    d = np.sqrt(((axes.place_mm[:, :2] - node[:2]) ** 2).sum(axis=1))
    reach = (d <= fall * members.tan) & (fall > 0) & (axes.below_mm > FOOT_MM)
    reach[-LEAVE_STEPS:] = False
    reach[:-LEAVE_STEPS] &= axes.upper[:-LEAVE_STEPS] == axes.upper[LEAVE_STEPS:]
    length = np.where(reach, np.hypot(fall, d), np.inf)
    best = int(np.argmin(length)) if len(length) else -1
    if best < 0 or length[best] >= cost_mm:
        return None
    foot, under = axes.place_mm[best], axes.place_mm[best + LEAVE_STEPS]
    half = float(members.across_mm(axes.above_mm[best]))
    own, entered = section(node - foot, half), section(foot - under, half)
    return Frustum(np.concatenate([under + entered, foot + own, node + own]), 2 * half)
