"""Rule: nothing sucks at the film while the part is printed in resin."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A vacuum of one bar on this area pulls with 10 N, as a layer of some square centimetres does.
LEAST_MM2 = 100.0


@rule("suction-cup")
def suction_cup(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents layers that tear off, or film that wears, where each peel pulls against a vacuum.

    A cup is an empty region of a layer with no way to the outside through the layers before it; the
    plate shuts what opens to it only.
    """
    if not profile.traits.peels_from_film:
        return
    cups = [cup for cup in context.cups if cup.area_mm2 >= LEAST_MM2]
    if not cups:
        return
    widest = max(cups, key=lambda cup: cup.area_mm2)
    total = sum(cup.volume_mm3 for cup in cups)
    until = f"opens at z = {widest.to_mm:.1f} mm" if widest.opens else "is closed over for good"
    many = f" ({len(cups)} such cups, the widest)" if len(cups) > 1 else ""
    yield finding(
        "suction-cup",
        f"A cup of {widest.area_mm2:.0f} mm² is shut toward the plate from "
        f"z = {widest.from_mm:.1f} mm until it {until}, and sucks at the film{many}.",
        "Vent it with a hole at its end toward the plate, or turn the part.",
        value=widest.area_mm2,
        limit=LEAST_MM2,
        at_mm=widest.place_mm,
        area_mm2=sum(cup.area_mm2 for cup in cups),
        volume_mm3=total,
    )
