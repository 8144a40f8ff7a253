"""Mending: what the acceptance rule still flags is carried by small funnels from the nearest
material, shell or vault."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.vaults.capitals import Capitals, cover
from printprep.cavity.vaults.ceiling import SPACING_MM
from printprep.cavity.vaults.dexels import Dexels
from printprep.cavity.vaults.feet import STEP_MM, nearest_feet, set_feet
from printprep.cavity.vaults.forest import Forest

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
) -> tuple[Capitals, Forest]:
    """Funnels and columns that carry flagged patches."""
    points = np.concatenate([_points(patch, layer_mm) for patch in flagged])
    capitals = cover(points, members, SPACING_MM**2)
    dexels = Dexels.of(cavity, dexel_mm)
    nodes = capitals.node_mm
    deepest = float(nodes[:, 2].max()) - dexels.floor_mm + STEP_MM
    _, feet = nearest_feet(nodes, np.zeros(len(nodes)), dexels, members, deepest)
    forest = Forest()
    for node, foot in zip(nodes, feet, strict=True):
        forest.stand(forest.plant(node), foot)
    set_feet(forest, dexels, members)
    return capitals, forest


def _points(patch: Flagged, layer_mm: float) -> Float:
    """(n, 3) its outline and its middle, thinned, where the void under it was cut."""
    outline = np.concatenate([*patch.outline_mm, [patch.at_mm[:2]]])
    _, first = np.unique(np.floor(outline / (SPACING_MM / 2)), axis=0, return_index=True)
    thinned = outline[np.sort(first)]
    return np.column_stack([thinned, np.full(len(thinned), patch.z_mm - layer_mm / 2)])
