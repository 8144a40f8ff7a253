"""Rule: how much of the surface hangs over."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.measure import arrays
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# What one support post holds anyway.
LEAST_MM2 = 10.0
# A facet of exactly the steepest overhang counts as printable after float32.
_SLACK_DEG = 0.01


@rule("overhang-area")
def overhang_area(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells what supports will be needed, outside and in cavities that are open.

    Surface that leans outward by more than the profile's overhang, above the first layer.  Powder
    carries everything; ceilings of sealed cavities have a rule of their own.
    """
    if profile.overhang_deg >= 90:
        return
    vertices, faces = arrays(context.outside)
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    steep = math.sin(math.radians(profile.overhang_deg + _SLACK_DEG))
    hangs = -normals[:, 2] > steep * doubled
    hangs &= corners[:, :, 2].max(axis=1) > profile.printer.first_layer_mm
    area = float(doubled[hangs].sum()) / 2
    if area < LEAST_MM2:
        return
    largest = int(np.argmax(np.where(hangs, doubled, 0)))
    x, y, z = corners[largest].mean(axis=0).tolist()
    yield finding(
        "overhang-area",
        f"{area:.0f} mm² of its surface hang over by more than {profile.overhang_deg:g}°: a slicer "
        "puts supports there.",
        "Another axis up (--up) or another pose (--pose) may need less.",
        value=area,
        limit=LEAST_MM2,
        at_mm=(x, y, z),
        area_mm2=area,
    )
