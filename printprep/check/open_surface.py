"""Rule: the triangles of the file form closed surfaces."""

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


@rule("open-surface")
def open_surface(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from closing holes in its own way, or from dropping whole layers."""
    del profile
    if context.raw is None:
        return
    ends, count = shared_edges(context.raw.faces)
    open_ = ends[count % 2 == 1]
    if len(open_) == 0:
        return
    yield finding(
        "open-surface",
        f"The surface is open at {counted(len(open_), 'edge')}: an odd number of triangles meets "
        "there.",
        "Close it with `printprep hollow`, or in the program that made the model.",
        value=float(len(open_)),
        limit=0.0,
        at_mm=mean_point(context.raw.vertices[open_[0]]),
    )
