"""Rule: a cavity that drains has a second hole, through which air comes in."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Through a hole this many times as wide as a drain hole, air and resin pass side by side.
WIDE = 3.0
# A smaller space empties by shaking.
LEAST_MM3 = 1000.0


@rule("no-vent")
def no_vent(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that a cavity has one hole only: resin leaves as slowly as air comes in through it."""
    diameter = profile.drain.diameter_mm
    if not profile.traits.leaves_pools or diameter is None:
        return
    single = [
        chamber
        for chamber in context.chambers(diameter)
        if chamber.openings == 1
        and chamber.widest_mm < WIDE * diameter
        and chamber.volume_mm3 >= LEAST_MM3
    ]
    if not single:
        return
    total = sum(chamber.volume_mm3 for chamber in single)
    if len(single) == 1:
        what = f"A cavity of {total / 1000:.3g} cm³ has a single hole"
    else:
        what = f"{len(single)} cavities of {total / 1000:.3g} cm³ have a single hole each"
    yield finding(
        "no-vent",
        f"{what} and no vent: {profile.traits.cavity_holds} runs out only as fast as air comes in "
        "through the same hole.",
        "Add a second hole at the other end of the cavity, as a vent.",
        value=total,
        at_mm=single[0].at_mm,
        volume_mm3=total,
    )
