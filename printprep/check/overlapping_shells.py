"""Rule: the shells of the file do not overlap."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.types import Finding
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("overlapping-shells")
def overlapping_shells(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that shells overlap: slicers print their union, other programs may not."""
    del profile
    self_intersections = context.self_intersections
    if self_intersections is None or not self_intersections.apart.any():
        return
    at = self_intersections.at_mm[self_intersections.apart]
    yield finding(
        "overlapping-shells",
        f"Separate shells cross at {counted(len(at), 'edge')}: a slicer prints their union.",
        "Unite them with `printprep hollow`, or in the program that made the model.",
        value=float(len(at)),
        limit=0.0,
        at_mm=mean_point(at[:1]),
    )
