"""Mending: what the acceptance rule still flags is carried by small funnels from the nearest
material, shell or vault."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.vaults.capitals import cover
from printprep.cavity.vaults.ceiling import SPACING_MM
from printprep.cavity.vaults.columns import FOOT_MM
from printprep.cavity.vaults.dexels import Dexels
from printprep.cavity.vaults.feet import STEP_MM, nearest_feet, set_feet
from printprep.cavity.vaults.forest import Axes, Forest
from printprep.cavity.vaults.solids import Frustum, columns, funnels, section

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.cavity.vaults.members import Members
    from printprep.overhang.rule import Flagged
    from printprep.types import Float


def mending(
    cavity: Manifold,
    flagged: Sequence[Flagged],
    layer_mm: float,
    members: Members,
    dexel_mm: float,
    axes: Axes,
) -> tuple[list[Frustum], list[Frustum]]:
    """Funnels under flagged patches, and a column for each.

    It stands where that is soonest, on shell or vaults; or it leans on an axis, at least as thick
    there as the column it enters: what stands out of its foot is less than a layer may reach.
    """
    members = replace(members, lean_deg=members.theta_deg)
    points = np.concatenate([_points(patch, layer_mm) for patch in flagged])
    capitals = cover(points, members, SPACING_MM**2)
    dexels = Dexels.of(cavity, dexel_mm)
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
    length = np.where(reach, np.hypot(fall, d), np.inf)
    best = int(np.argmin(length)) if len(length) else -1
    if best < 0 or length[best] >= cost_mm:
        return None
    foot = axes.place_mm[best]
    thick = float(members.across_mm(axes.above_mm[best : best + 1])[0])
    round_ = section(node - foot, thick)
    return Frustum(np.concatenate([foot + round_, node + round_]), 2 * thick)


def _points(patch: Flagged, layer_mm: float) -> Float:
    """(n, 3) its outline and its middle, thinned, where the void under it was cut."""
    outline = np.concatenate([*patch.outline_mm, [patch.at_mm[:2]]])
    _, first = np.unique(np.floor(outline / (SPACING_MM / 2)), axis=0, return_index=True)
    thinned = outline[np.sort(first)]
    return np.column_stack([thinned, np.full(len(thinned), patch.z_mm - layer_mm / 2)])
