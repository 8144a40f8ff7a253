"""Mending: what the acceptance rule still flags is carried too.

It is tried on blocks cut from around the patches: small, they are quickly built in and judged.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.vaults.ceiling import SPACING_MM
from printprep.cavity.vaults.dexels import DEXEL_MM, Dexels
from printprep.cavity.vaults.gussets import gussets
from printprep.cavity.vaults.props import propped
from printprep.cavity.vaults.solids import Frustum, united
from printprep.overhang.rule import Flagged, Unsupported, unsupported_ceilings
from printprep.overhang.suspects import Suspects

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.cavity.vaults.capitals import Capitals
    from printprep.cavity.vaults.forest import Forest
    from printprep.cavity.vaults.members import Members
    from printprep.overhang.limits import Acceptance
    from printprep.types import Float

# Layers begin at these shares of a layer.
PHASES = (0.0, 0.5)
MOST_ROUNDS = 4
# Blocks reach so far around what is flagged.
BLOCK_MM = 5.0


def mended(
    cavity: Manifold,
    flagged: tuple[Flagged, ...],
    rule: Acceptance,
    members: Members,
    capitals: Capitals,
    forest: Forest,
) -> tuple[list[Frustum], list[Frustum], tuple[Flagged, ...]]:
    """Capitals and columns, until blocks cut from around all patches are flagged no more, and what
    still is.

    Capitals are widened where that will do; what is left gets funnels and columns of its own.
    """
    block = cavity ^ _blocks(flagged)
    dexels: Dexels | None = None
    wide: list[Frustum] = []
    narrow: list[Frustum] = []
    for _ in range(MOST_ROUNDS):
        points = np.concatenate([_points(patch, rule.layer_mm) for patch in flagged])
        under, points = gussets(points, capitals, forest, members)
        props: list[Frustum] = []
        if len(points):
            dexels = dexels or Dexels.of(cavity, DEXEL_MM)
            more, props = propped(dexels, points, members, forest.axes())
            under += more
        wide, narrow = wide + under, narrow + props
        block = block - united(under + props)
        flagged = flagged_near(under + props, block, rule).patches
        if not flagged:
            break
    return wide, narrow, flagged


def _blocks(flagged: Sequence[Flagged]) -> Manifold:
    """Cubes around all patches."""
    from manifold3d import Manifold, OpType

    cube = Manifold.cube((2 * BLOCK_MM,) * 3, center=True)
    return Manifold.batch_boolean([cube.translate(patch.at_mm) for patch in flagged], OpType.Add)


def flagged_near(pieces: Sequence[Frustum], cavity: Manifold, rule: Acceptance) -> Unsupported:
    """What the rule flags where pieces were just built: elsewhere nothing changed."""
    low, high = (np.array(ends) for ends in zip(*(piece.bounds() for piece in pieces), strict=True))
    beyond = np.array([rule.off_mm, rule.off_mm, rule.layer_mm])
    suspects = Suspects.of(cavity, rule).near(low - beyond, high + beyond)
    return unsupported_ceilings(cavity, rule, PHASES, suspects)


def _points(patch: Flagged, layer_mm: float) -> Float:
    """(n, 3) its outline and its middle, thinned, where the void under it was cut."""
    outline = np.concatenate([*patch.outline_mm, [patch.at_mm[:2]]])
    _, first = np.unique(np.floor(outline / (SPACING_MM / 2)), axis=0, return_index=True)
    thinned = outline[np.sort(first)]
    return np.column_stack([thinned, np.full(len(thinned), patch.z_mm - layer_mm / 2)])
