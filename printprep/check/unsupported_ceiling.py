"""Rule: ceilings of cavities that nothing carries, and islands inside cavities."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less than this, over all layers, is a few specks that bridge.
AREA_MM2 = 0.5


@rule("unsupported-ceiling")
def unsupported_ceiling(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a ceiling that sags into the cavity, and supports that no one can remove.

    Where the file tells the slicer to make no supports, it applies the printer's rule, layer by
    layer; elsewhere the slicer's own rule for supports.  A single island is enough, since it prints
    in mid-air.
    """
    if not profile.traits.ceilings_sag or not (context.cavities or context.drained):
        return
    from printprep.check.walls import united
    from printprep.overhang.limits import acceptance
    from printprep.overhang.rule import unsupported_ceilings

    blocked = context.blocker is not None
    accepted = acceptance(profile, "printer" if blocked else "slicer")
    ceilings = unsupported_ceilings(united((*context.cavities, *context.drained)), accepted)
    worst = ceilings.worst
    if worst is None or (ceilings.area_mm2 <= AREA_MM2 and not ceilings.islands):
        return
    count = "1 island starts" if ceilings.islands == 1 else f"{ceilings.islands} islands start"
    islands = f", and {count} in mid-air" if ceilings.islands else ""
    after = (
        "they sag, since the file keeps the slicer's supports out"
        if blocked
        else "a slicer prints supports there, which stay inside"
    )
    yield finding(
        "unsupported-ceiling",
        f"{ceilings.area_mm2:.1f} mm² of cavity ceilings, over all layers, are "
        f"unsupported{islands}: {after}.",
        "Leave out --vaults none: vaults then carry the ceilings."
        if context.hollowed
        else "Hollow the solid model with `printprep hollow`, which adds vaults for filament.",
        value=ceilings.area_mm2,
        limit=AREA_MM2,
        at_mm=worst.at_mm,
    )
