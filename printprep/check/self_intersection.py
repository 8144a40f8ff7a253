"""Rule: no shell of the file passes through itself."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("self-intersection")
def self_intersection(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents slicers from disagreeing on what is inside where a surface passes through itself."""
    del profile
    self_intersections = context.self_intersections
    if self_intersections is None or self_intersections.apart.all():
        return
    at = self_intersections.at_mm[~self_intersections.apart]
    x, y, z = at[0].tolist()
    yield finding(
        "self-intersection",
        f"The surface passes through itself at {len(at)} edges: programs differ on what is inside.",
        "Unite it with itself in a modelling program: hollowing keeps what changes little.",
        value=float(len(at)),
        limit=0.0,
        at_mm=(x, y, z),
    )
