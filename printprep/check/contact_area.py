"""Rule: a tall part has enough contact with the bed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# The nozzle knocks off a part with less contact than this that is taller than that.
LEAST_MM2 = 25.0
TALL_MM = 20.0


@rule("contact-area")
def contact_area(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a tall print with little contact from coming loose while it prints.

    For filament only: a resin part hangs on supports, and powder holds the part in place.
    """
    area = context.stability.contact_area_mm2
    if not profile.traits.loosens_from_bed or context.stability.tilt_deg is None:
        return
    if area >= LEAST_MM2 or context.size_mm[2] <= TALL_MM:
        return
    x, y = context.stability.support_polygon_mm.mean(axis=0).tolist()
    yield finding(
        "contact-area",
        f"The part is {context.size_mm[2]:.0f} mm tall and touches the bed with only "
        f"{area:.1f} mm².",
        "Print it with a brim, or give it a base (`printprep hollow --base always`).",
        value=area,
        limit=LEAST_MM2,
        at_mm=(x, y, 0.0),
        area_mm2=area,
    )
