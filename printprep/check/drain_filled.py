"""Rule: room for a cavity that stayed solid because no hole drains it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less than this is the slope that floors get.
FILLED_MM3 = 100.0


@rule("drain-filled")
def drain_filled(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Explains why a cavity was left solid."""
    drainage = context.drainage
    if drainage is None:
        return
    diameter = profile.drain.diameter_mm
    if drainage.closed_mm3:
        total = sum(drainage.closed_mm3)
        count = len(drainage.closed_mm3)
        cavities = "A cavity" if count == 1 else f"{count} cavities"
        yield finding(
            "drain-filled",
            f"{cavities} of {total / 1000:.3g} cm³ stayed solid: no hole of {diameter:g} mm drains "
            f"{'it' if count == 1 else 'them'}.",
            "Try a smaller --drain-diameter, if the resin or powder still runs through it.",
            value=total,
        )
    if drainage.filled_mm3 > FILLED_MM3:
        yield finding(
            "drain-filled",
            f"{drainage.filled_mm3 / 1000:.3g} cm³ of cavity floors are filled, where a pool would "
            "stand below every outlet.",
            value=drainage.filled_mm3,
        )
