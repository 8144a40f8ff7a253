"""Rule: the triangles of the file face outward."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.orient import right_side_out
from printprep.types import Finding
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("orientation")
def orientation(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from taking material for a void where triangles face inward.

    The triangles of a part that printprep made bound its material: the geometry kernel says so.
    """
    del profile
    raw = context.raw
    if raw is None or context.hollowed:
        return
    outward, _ = right_side_out(raw.vertices, raw.faces)
    turned = np.flatnonzero((outward != raw.faces).any(axis=1))
    if len(turned) == 0:
        return
    yield finding(
        "orientation",
        f"{len(turned)} of {counted(len(raw.faces), 'triangle')} "
        f"{'faces' if len(turned) == 1 else 'face'} inward: a slicer may take material for empty "
        "space.",
        "Turn them with `printprep hollow`, or in the program that made the model.",
        value=float(len(turned)),
        limit=0.0,
        at_mm=mean_point(raw.vertices[raw.faces[turned[0]]]),
    )
