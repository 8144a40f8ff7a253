"""Rule: the part is a closed surface that encloses a positive volume."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.quantize import crowded_edges, quantized_arrays
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

_FIX = "Repair it with `printprep hollow`, or in the program that made the model."


@rule("watertight")
def watertight(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from silently filling a cavity, or from leaving a layer open.

    Where one triangle of an inner shell is missing, PrusaSlicer 2.5.0 prints the cavity solid and
    gives no warning.  The rule checks the float32 triangles that a file holds: every directed edge
    occurs exactly once and its opposite exactly once, the geometry kernel accepts the mesh, and the
    signed volume is positive.  For a file as it came, other rules check the edges.
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
    if len(crowded) and (context.hollowed or context.raw is None):
        yield finding(
            "watertight",
            f"{len(crowded)} edges are not shared by exactly two triangles with the same "
            "orientation.",
            _FIX,
            value=float(len(crowded)),
            limit=0.0,
            at_mm=mean_point(vertices[crowded[0]]),
        )
    volume_mm3 = float(context.part.volume())
    if volume_mm3 <= 0:
        yield finding(
            "watertight",
            f"The surface encloses {volume_mm3:g} mm³: it is empty or inside out.",
            _FIX,
            value=volume_mm3,
            limit=0.0,
        )
