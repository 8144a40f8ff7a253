"""Rule: two triangles of the file meet at every edge."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.weld import shared_edges
from printprep.types import Finding
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("non-manifold-edges")
def non_manifold_edges(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents programs from separating bodies differently where they touch along an edge."""
    del profile
    if context.raw is None:
        return
    ends, count = shared_edges(context.raw.faces)
    crowded = ends[(count > 2) & (count % 2 == 0)]
    if len(crowded) == 0:
        return
    yield finding(
        "non-manifold-edges",
        f"More than two triangles meet at {counted(len(crowded), 'edge')}: bodies touch there "
        "along a line.",
        "Separate the bodies, or let them overlap; `printprep hollow` does either.",
        value=float(len(crowded)),
        limit=0.0,
        at_mm=mean_point(context.raw.vertices[crowded[0]]),
    )
