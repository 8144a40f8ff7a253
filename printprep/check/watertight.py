"""Rule: what is written is one closed surface that knows its inside."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.quantize import crowded_edges, quantized_arrays
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

_FIX = "Run it through `printprep hollow`, which repairs it, or repair it where it was made."


@rule("watertight")
def watertight(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer that silently fills a cavity, or leaves a layer open.

    One triangle missing from an inner shell and PrusaSlicer 2.5.0 prints the cavity solid without
    a word.  Judged on the float32 triangles a file holds: every directed edge occurs exactly once
    and its opposite exactly once, the kernel takes the mesh, and the signed volume is positive.
    Edges of a file as it came are judged on its own triangles, by other rules.
    """
    del profile
    status = str(context.part.status().name)
    if status != "NoError":
        yield finding(
            "watertight",
            f"The part is not a manifold: {status}.",
            _FIX,
        )
        return
    vertices, faces = quantized_arrays(context.part)
    crowded = crowded_edges(faces)
    if len(crowded) and context.raw is None:
        x, y, z = vertices[crowded[0]].mean(axis=0).tolist()
        yield finding(
            "watertight",
            f"{len(crowded)} edges are not shared by exactly two triangles that face the same way.",
            _FIX,
            value=float(len(crowded)),
            limit=0.0,
            at_mm=(x, y, z),
        )
    volume_mm3 = float(context.part.volume())
    if volume_mm3 <= 0:
        yield finding(
            "watertight",
            f"The surface encloses {volume_mm3:g} mm³: it is inside out or encloses nothing.",
            _FIX,
            value=volume_mm3,
            limit=0.0,
        )
