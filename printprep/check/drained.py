"""Rule: what was filled because no drain takes it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less than this is the slope that floors are given.
FILLED_MM3 = 100.0


@rule("drain-filled")
def drain_filled(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents wonder at material where there was room for a cavity."""
    found = context.drainage
    if found is None:
        return
    diameter = profile.drain.diameter_mm
    if found.closed_mm3:
        total = sum(found.closed_mm3)
        count = len(found.closed_mm3)
        what = "A cavity" if count == 1 else f"{count} cavities"
        yield finding(
            "drain-filled",
            f"{what} of {total / 1000:.3g} cm³ stayed solid: no hole of {diameter:g} mm drains "
            f"{'it' if count == 1 else 'them'}.",
            "A smaller --drain-diameter reaches more, where the resin or powder runs through it.",
            value=total,
        )
    if found.filled_mm3 > FILLED_MM3:
        yield finding(
            "drain-filled",
            f"{found.filled_mm3 / 1000:.3g} cm³ of cavities' floors were filled, where liquid "
            "would have stood below every outlet.",
            value=found.filled_mm3,
        )
