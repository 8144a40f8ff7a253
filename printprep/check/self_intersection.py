"""Rule: no shell of the file intersects itself."""

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


@rule("self-intersection")
def self_intersection(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents programs from disagreeing on what is inside where a surface intersects itself."""
    del profile
    self_intersections = context.self_intersections
    if self_intersections is None or self_intersections.apart.all():
        return
    at = self_intersections.at_mm[~self_intersections.apart]
    yield finding(
        "self-intersection",
        f"The surface intersects itself at {counted(len(at), 'edge')}: programs disagree on what "
        "is inside.",
        "Unite it with itself in a modelling program; `printprep hollow` may leave it as it is.",
        value=float(len(at)),
        limit=0.0,
        at_mm=mean_point(at[:1]),
    )
