"""Rule: holes let out what they are there for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

_WHAT = {"resin": "resin", "powder": "powder"}


@rule("drain-too-small")
def drain_too_small(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents holes through which nothing runs: too narrow themselves, or behind a narrow neck.

    The widest ball that gets out of a space, by any way, is compared with the profile's drain.
    """
    what, diameter = _WHAT.get(profile.process), profile.drain.diameter_mm
    if what is None or diameter is None:
        return
    found = [pocket for pocket in context.pockets(diameter) if pocket.kind == "narrow"]
    if not found:
        return
    total = sum(pocket.volume_mm3 for pocket in found)
    worst = max(found, key=lambda pocket: pocket.volume_mm3)
    spaces = "A space" if len(found) == 1 else f"{len(found)} spaces"
    width = worst.way_out_mm or 0.0
    yield Finding(
        "drain-too-small",
        "error",
        f"{spaces} with {total / 1000:.3g} cm³ of {what} {'has' if len(found) == 1 else 'have'} "
        f"no way out as wide as {diameter:g} mm; the widest of the largest is {width:.1f} mm.",
        f"Drill its hole, or the neck behind it, to {diameter:g} mm.",
        value=width,
        limit=diameter,
        unit="mm",
        at_mm=worst.place_mm,
        volume_mm3=total,
    )
