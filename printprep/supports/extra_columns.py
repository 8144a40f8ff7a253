"""Props: small funnels, each on a column of its own from the nearest material, shell or vault."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.capitals import cover
from printprep.supports.ceiling import SPACING_MM
from printprep.supports.columns import FOOT_MM
from printprep.supports.feet import STEP_MM, nearest_feet, set_feet
from printprep.supports.forest import Axes, Forest
from printprep.supports.solids import Frustum, columns, funnels, section

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.supports.dexels import Dexels
    from printprep.supports.members import Members

# Points of an axis, from where a column that leans on it begins to stand out of it.
LEAVE_STEPS = 3


def propped(
    dexels: Dexels, points: Float, members: Members, axes: Axes
) -> tuple[list[Frustum], list[Frustum]]:
    """Funnels under points (n, 3) of ceiling, and a column for each.

    It stands where that is soonest, on shell or vaults; or it leans on an axis, as thick as the
    column it enters.
    """
    members = replace(members, lean_deg=members.theta_deg)
    capitals = cover(points, members, SPACING_MM**2, dexels)
    nodes = capitals.node_mm
    deepest = float(nodes[:, 2].max()) - dexels.floor_mm + STEP_MM
    price, feet = nearest_feet(nodes, np.zeros(len(nodes)), dexels, members, deepest)
    forest = Forest()
    props = []
    for node, foot, cost in zip(nodes, feet, price.tolist(), strict=True):
        prop = _on_axis(node, cost, axes, members)
        if prop is None:
            forest.stand(forest.plant(node), foot)
        else:
            props.append(prop)
    set_feet(forest, dexels, members)
    return funnels(capitals, members), columns(forest, members) + props


def _on_axis(node: Float, cost_mm: float, axes: Axes, members: Members) -> Frustum | None:
    """The column to the nearest point of an axis, where that is shorter than ``cost_mm``."""
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
