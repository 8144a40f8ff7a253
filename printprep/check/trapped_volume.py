"""Rule: resin runs out of the part while it stands."""

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
    """Prevents resin that stays in a part despite its holes, and leaks for weeks or cures inside.

    It counts the pools that do not run out while the part stands; turning the part empties them.  A
    pool is a warning inside the part, and information in the open, as in a mug.  Sealed cavities
    and holes that are too small have their own rules.
    """
    diameter = profile.drain.diameter_mm
    # Powder is shaken and blown out, however the part stands.
    if not profile.traits.leaves_pools or diameter is None:
        return
    pools = [pocket for pocket in context.pockets(diameter) if pocket.kind == "pool"]
    for enclosed in (True, False):
        alike = [pocket for pocket in pools if pocket.enclosed is enclosed]
        if alike:
            yield _pools_finding(alike, enclosed=enclosed)


def _pools_finding(pools: list[Pocket], *, enclosed: bool) -> Finding:
    total = sum(pocket.volume_mm3 for pocket in pools)
    largest = max(pools, key=lambda pocket: pocket.volume_mm3)
    where = "inside the part" if enclosed else "in open hollows of the part"
    return finding(
        "trapped-volume",
        f"While the part stands, {total / 1000:.3g} cm³ of resin stay {where}; the largest pool is "
        f"{largest.depth_mm:.3g} mm deep.",
        "Turn the part over before it cures, or put a drain hole at the lowest place.",
        severity="warning" if enclosed else "info",
        value=total,
        limit=0.0,
        at_mm=largest.place_mm,
        volume_mm3=total,
    )
