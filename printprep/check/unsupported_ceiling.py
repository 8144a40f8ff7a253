"""Rule: ceilings of cavities that a slicer would fill with support, and islands inside them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less than this, over all layers, is a few crumbs that bridge.
AREA_MM2 = 0.5


@rule("unsupported-ceiling")
def unsupported_ceiling(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a ceiling that sags into the cavity, or support shut in where no hand can reach.

    By the slicer's own rule, layer by layer; its loose pieces, which print on air, count at once.
    """
    if not profile.traits.ceilings_sag or not context.cavities:
        return
    from printprep.check.walls import united
    from printprep.overhang.limits import acceptance
    from printprep.overhang.rule import unsupported_ceilings

    found = unsupported_ceilings(united(context.cavities), acceptance(profile))
    worst = found.worst
    if worst is None or (found.area_mm2 <= AREA_MM2 and not found.islands):
        return
    count = "1 piece begins" if found.islands == 1 else f"{found.islands} pieces begin"
    islands = f", {count} on air" if found.islands else ""
    yield finding(
        "unsupported-ceiling",
        f"Ceilings inside cavities overhang by {found.area_mm2:.1f} mm² over all layers{islands}; "
        "a slicer prints support there, which stays inside.",
        "Hollow it with supports of its own inside, as `printprep hollow` does for filament.",
        value=found.area_mm2,
        limit=AREA_MM2,
        at_mm=worst.at_mm,
    )
