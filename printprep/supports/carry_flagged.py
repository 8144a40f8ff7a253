"""Carry what the acceptance rule still flags, with gussets and further columns.

The rule judges blocks cut from around the new pieces: small blocks are quick to judge.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.overhang.rule import Flagged, unsupported_ceilings
from printprep.overhang.suspects import Suspects
from printprep.supports.ceiling import SPACING_MM
from printprep.supports.extra_columns import extra_columns
from printprep.supports.gussets import gussets
from printprep.supports.inside_lookup import LOOKUP_MM, InsideLookup
from printprep.supports.solids import Frustum, united

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.overhang.limits import Acceptance
    from printprep.supports.capitals import Capitals
    from printprep.supports.column_forest import Forest
    from printprep.supports.member_sizes import MemberSizes

# Layers begin at these shares of a layer.
PHASES = (0.0, 0.5)
MOST_ROUNDS = 8
# Blocks reach so far beyond the pieces: farther than the rule looks.
BLOCK_MM = 2.0


def carry_flagged(
    cavity: Manifold,
    flagged: tuple[Flagged, ...],
    rule: Acceptance,
    members: MemberSizes,
    capitals: Capitals,
    forest: Forest,
) -> tuple[list[Frustum], list[Frustum], tuple[Flagged, ...]]:
    """Add capitals and columns until the rule flags nothing around them.

    Gussets widen capitals where that is enough; the rest gets funnels and columns of its own.
    Returns the new capitals and gussets, the new columns, and what is still flagged.
    """
    lookup: InsideLookup | None = None
    wide: list[Frustum] = []
    narrow: list[Frustum] = []
    for _ in range(MOST_ROUNDS):
        if not flagged:
            break
        points = np.concatenate([_points(patch, rule.layer_mm) for patch in flagged])
        under, points = gussets(points, capitals, forest, members)
        added: list[Frustum] = []
        if len(points):
            lookup = lookup or InsideLookup.of(cavity, LOOKUP_MM)
            more, added = extra_columns(lookup, points, members, forest.axes())
            under += more
        wide, narrow = wide + under, narrow + added
        block = (cavity ^ _around(wide + narrow)) - united(wide + narrow)
        flagged = _flagged_near(under + added, block, rule)
    return wide, narrow, flagged


def _around(pieces: Sequence[Frustum]) -> Manifold:
    """The boxes of pieces, with a margin."""
    from manifold3d import Manifold, OpType

    boxes = []
    for low, high in (piece.bounds() for piece in pieces):
        box = Manifold.cube((high - low + 2 * BLOCK_MM).tolist())
        boxes.append(box.translate((low - BLOCK_MM).tolist()))
    return Manifold.batch_boolean(boxes, OpType.Add)


def _flagged_near(
    pieces: Sequence[Frustum], cavity: Manifold, rule: Acceptance
) -> tuple[Flagged, ...]:
    """What the rule flags around the new pieces: elsewhere nothing changed."""
    low, high = (np.array(ends) for ends in zip(*(piece.bounds() for piece in pieces), strict=True))
    beyond = np.array([rule.off_mm, rule.off_mm, rule.layer_mm])
    suspects = Suspects.of(cavity, rule).near(low - beyond, high + beyond)
    return unsupported_ceilings(cavity, rule, PHASES, suspects).patches


def _points(patch: Flagged, layer_mm: float) -> Float:
    """(n, 3) mm, outline and middle of a flagged patch, thinned, at the height of its section."""
    outline = np.concatenate([*patch.outline_mm, [patch.at_mm[:2]]])
    _, first = np.unique(np.floor(outline / (SPACING_MM / 2)), axis=0, return_index=True)
    thinned = outline[np.sort(first)]
    return np.column_stack([thinned, np.full(len(thinned), patch.z_mm - layer_mm / 2)])
