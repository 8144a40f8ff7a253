"""Rule: the part holds on to the bed with enough of its first layer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A foot smaller than this under something taller than that is knocked off by the nozzle.
LEAST_MM2 = 25.0
TALL_MM = 20.0


@rule("contact-area")
def contact_area(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a tall print on a small foot from coming loose half way up.

    Filament only: resin hangs on supports, powder holds what lies in it.
    """
    area = context.stability.contact_area_mm2
    if not profile.traits.loosens_from_bed or context.stability.tilt_deg is None:
        return
    if area >= LEAST_MM2 or context.size_mm[2] <= TALL_MM:
        return
    x, y = context.stability.support_polygon_mm.mean(axis=0).tolist()
    yield finding(
        "contact-area",
        f"It is {context.size_mm[2]:.0f} mm tall and touches the bed with {area:.1f} mm² only.",
        "Print it with a brim, or give it a base (hollow --base always).",
        value=area,
        limit=LEAST_MM2,
        at_mm=(x, y, 0.0),
        area_mm2=area,
    )
