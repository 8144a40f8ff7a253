"""Rule: gaps are wide enough to print open."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

TOLERANCE_MM = 0.01
# A gap with less surface than this is a fold.
LEAST_MM2 = 5.0
# Places closer than this are one gap.
_LINK_MM = 2.0
# A gap is about equally wide everywhere: the narrowest tenth of it is at least this share of the
# median wide.  In a crease, or under a ball on a plate, it is a fifth of the median or less.
_EVEN = 0.5


@rule("gap")
def gap(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells of surfaces that may fuse together: a hinge that sticks, letters that fill up.

    Two sides form a gap where they are nearly parallel and stay apart; a crease is not a gap.
    """
    limit = profile.min_gap_mm
    if limit is None:
        return
    patches = [
        patch
        for patch in context.narrow_below(limit - TOLERANCE_MM).patches(_LINK_MM)
        if patch.total_mm2 >= LEAST_MM2
        and np.percentile(patch.thick_mm, 10) >= _EVEN * np.median(patch.thick_mm)
    ]
    if not patches:
        return
    narrow = max(patches, key=lambda patch: patch.total_mm2)
    total = sum(patch.total_mm2 for patch in patches)
    least, place = narrow.thinnest
    yield finding(
        "gap",
        f"A gap of {least:.2f} mm may print closed; it should be {limit:g} mm wide "
        f"({total:.0f} mm² of surface).",
        "Widen the gap, or join its two sides.",
        value=least,
        limit=limit,
        at_mm=place,
        area_mm2=total,
    )
