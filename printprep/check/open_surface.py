"""Rule: the file's triangles close."""

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


@rule("open-surface")
def open_surface(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from closing holes its own way, or from dropping whole layers."""
    del profile
    if context.raw is None:
        return
    ends, count = shared_edges(context.raw.faces)
    open_ = ends[count % 2 == 1]
    if len(open_) == 0:
        return
    x, y, z = context.raw.vertices[open_[0]].mean(axis=0).tolist()
    yield finding(
        "open-surface",
        f"The surface is open: {len(open_)} edges belong to an odd number of triangles.",
        "`printprep hollow` closes it, or repair it where it was made.",
        value=float(len(open_)),
        limit=0.0,
        at_mm=(x, y, z),
    )
