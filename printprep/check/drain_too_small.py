"""Rule: drain holes are wide enough to drain."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A way out is measured to 0.05 mm: this share of a hole of 2.5 mm.
MEASURED = 0.02


@rule("drain-too-small")
def drain_too_small(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents drain holes that do not drain: too narrow, or behind a narrow neck.

    The widest ball that gets out of a space, by any way, is compared with the profile's drain hole.
    """
    diameter = profile.drain.diameter_mm
    if not profile.traits.must_drain or diameter is None:
        return
    narrow = [
        pocket
        for pocket in context.pockets(diameter)
        if pocket.kind == "narrow" and (pocket.way_out_mm or 0.0) < (1 - MEASURED) * diameter
    ]
    if not narrow:
        return
    total = sum(pocket.volume_mm3 for pocket in narrow)
    largest = max(narrow, key=lambda pocket: pocket.volume_mm3)
    width = largest.way_out_mm or 0.0
    holds = f"{total / 1000:.3g} cm³ of {profile.traits.cavity_holds}"
    if len(narrow) == 1:
        message = f"A space that holds {holds} has a way out only {width:.1f} mm wide"
    else:
        message = (
            f"{len(narrow)} spaces that hold {holds} have ways out that are too narrow, the "
            f"largest space one of {width:.1f} mm"
        )
    yield finding(
        "drain-too-small",
        f"{message}; a drain hole should be {diameter:g} mm wide.",
        f"Widen the hole, or the neck behind it, to {diameter:g} mm.",
        value=width,
        limit=diameter,
        at_mm=largest.place_mm,
        volume_mm3=total,
    )
