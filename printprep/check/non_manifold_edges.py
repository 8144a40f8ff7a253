"""Rule: two of the file's triangles at every edge."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.weld import shared_edges
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("non-manifold-edges")
def non_manifold_edges(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents programs from parting the surface in different ways where it touches itself."""
    del profile
    if context.raw is None:
        return
    ends, count = shared_edges(context.raw.faces)
    crowded = ends[(count > 2) & (count % 2 == 0)]
    if len(crowded) == 0:
        return
    x, y, z = context.raw.vertices[crowded[0]].mean(axis=0).tolist()
    yield finding(
        "non-manifold-edges",
        f"At {len(crowded)} edges more than two triangles meet: bodies touch there along a line.",
        "Part them or let them overlap; `printprep hollow` does one or the other.",
        value=float(len(crowded)),
        limit=0.0,
        at_mm=(x, y, z),
    )
