"""Rule: holes let out what they are there for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("drain-too-small")
def drain_too_small(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents holes through which nothing runs: too narrow themselves, or behind a narrow neck.

    The widest ball that gets out of a space, by any way, is compared with the profile's drain.
    """
    diameter = profile.drain.diameter_mm
    if not profile.traits.must_drain or diameter is None:
        return
    found = [pocket for pocket in context.pockets(diameter) if pocket.kind == "narrow"]
    if not found:
        return
    total = sum(pocket.volume_mm3 for pocket in found)
    worst = max(found, key=lambda pocket: pocket.volume_mm3)
    spaces = "A space has" if len(found) == 1 else f"{len(found)} spaces have"
    width = worst.way_out_mm or 0.0
    yield finding(
        "drain-too-small",
        f"{spaces} no way out {diameter:g} mm wide: {total / 1000:.3g} cm³ of "
        f"{profile.traits.cavity_holds} stay inside; the largest space opens {width:.1f} mm wide.",
        f"Drill its hole, or the neck behind it, to {diameter:g} mm.",
        value=width,
        limit=diameter,
        at_mm=worst.place_mm,
        volume_mm3=total,
    )
