"""Rule: no suction cup forms while the part is printed in resin."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A vacuum of one bar on this area pulls with 10 N, as a layer of a few square centimetres does.
LEAST_MM2 = 100.0


@rule("suction-cup")
def suction_cup(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents torn layers and a worn film where each peel pulls against a vacuum.

    A suction cup is an empty region of a layer with no way to the outside through the layers before
    it.  The plate closes whatever opens only toward it.
    """
    if not profile.traits.peels_from_film:
        return
    cups = [cup for cup in context.cups if cup.area_mm2 >= LEAST_MM2]
    if not cups:
        return
    widest = max(cups, key=lambda cup: cup.area_mm2)
    total = sum(cup.volume_mm3 for cup in cups)
    if len(cups) == 1:
        cup = f"A suction cup of {widest.area_mm2:.0f} mm²"
    else:
        cup = f"The widest of {len(cups)} suction cups, {widest.area_mm2:.0f} mm²,"
    end = "" if widest.opens else ", where a ceiling seals it"
    yield finding(
        "suction-cup",
        f"{cup} forms from z = {widest.from_mm:.1f} mm to z = {widest.to_mm:.1f} mm{end}.",
        "Add a vent at its end toward the plate, or turn the part.",
        value=widest.area_mm2,
        limit=LEAST_MM2,
        at_mm=widest.place_mm,
        area_mm2=sum(cup.area_mm2 for cup in cups),
        volume_mm3=total,
    )
