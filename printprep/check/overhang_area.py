"""Rule: how much of the surface overhangs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.measure import area_normals, arrays
from printprep.overhang.limits import THRESHOLD_DEG
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less than this is too little to report.
LEAST_MM2 = 10.0
# A facet at exactly the profile's overhang still counts as printable after rounding to float32.
_SLACK_DEG = 0.01


@rule("overhang-area")
def overhang_area(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells how much surface needs supports, outside and in open cavities.

    It counts surface above the first layer that leans outward by more than the profile's overhang,
    with filament by more than a slicer leaves without supports.
    Powder carries every overhang; ceilings of sealed cavities have their own rule.
    """
    limit_deg = profile.overhang_deg
    if profile.traits.has_nozzle:
        limit_deg = min(limit_deg, THRESHOLD_DEG)
    if limit_deg >= 90:
        return
    vertices, faces = arrays(context.outside)
    corners = vertices[faces]
    normals = area_normals(corners)
    doubled = np.linalg.norm(normals, axis=1)
    steep = math.sin(math.radians(limit_deg + _SLACK_DEG))
    hangs = -normals[:, 2] > steep * doubled
    hangs &= corners[:, :, 2].max(axis=1) > profile.printer.first_layer_mm
    area = float(doubled[hangs].sum()) / 2
    if area < LEAST_MM2:
        return
    largest = int(np.argmax(np.where(hangs, doubled, 0)))
    yield finding(
        "overhang-area",
        f"{area:.0f} mm² of the surface overhang by more than {limit_deg:g}°: a slicer "
        "adds supports there.",
        "Try another axis up (--up), or another pose (`printprep hollow --pose`).",
        value=area,
        limit=LEAST_MM2,
        at_mm=mean_point(corners[largest]),
        area_mm2=area,
    )
