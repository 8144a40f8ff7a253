"""Rule: resin runs out of the part as it stands."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.drainage.trapped import Pocket
    from printprep.profiles import Profile


@rule("trapped-volume")
def trapped_volume(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents resin that stays in a part with holes, and leaks for weeks or cures where it lies.

    What does not run out of the part as it stands, through the ways out that it has; turning it is
    enough.  A warning inside it, information in the open, as in a mug.  Sealed cavities and holes
    that are too small have rules of their own.
    """
    diameter = profile.drain.diameter_mm
    # Powder is shaken and blown out, whichever way the part stands.
    if not profile.traits.leaves_pools or diameter is None:
        return
    pools = [pocket for pocket in context.pockets(diameter) if pocket.kind == "pool"]
    for enclosed in (True, False):
        found = [pocket for pocket in pools if pocket.enclosed is enclosed]
        if found:
            yield _pools(found, enclosed=enclosed)


def _pools(found: list[Pocket], *, enclosed: bool) -> Finding:
    total = sum(pocket.volume_mm3 for pocket in found)
    largest = max(found, key=lambda pocket: pocket.volume_mm3)
    where = "inside it" if enclosed else "in its hollows"
    return finding(
        "trapped-volume",
        f"As it stands {total / 1000:.3g} cm³ of resin stay {where}, the largest pool "
        f"{largest.depth_mm:.3g} mm deep.",
        "Turn the part over before it is cured, or put a drain at the lowest place.",
        severity="warning" if enclosed else "info",
        value=total,
        limit=0.0,
        at_mm=largest.place_mm,
        volume_mm3=total,
    )
