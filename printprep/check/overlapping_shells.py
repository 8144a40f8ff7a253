"""Rule: the file's shells do not reach into each other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("overlapping-shells")
def overlapping_shells(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that shells overlap: slicers print what they cover together, other programs differ."""
    del profile
    self_intersections = context.self_intersections
    if self_intersections is None or not self_intersections.apart.any():
        return
    at = self_intersections.at_mm[self_intersections.apart]
    x, y, z = at[0].tolist()
    yield finding(
        "overlapping-shells",
        f"Separate shells overlap at {len(at)} edges: a slicer prints what they cover together.",
        "Unite them where they were made; `printprep hollow` does too.",
        value=float(len(at)),
        limit=0.0,
        at_mm=(x, y, z),
    )
