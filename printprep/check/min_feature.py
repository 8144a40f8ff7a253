"""Rule: pins and rods are at least as thick as the profile's minimum feature."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.check.wall_thickness import FACETED
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# Less surface than this is a tip, which is meant to be thin.
LEAST_MM2 = 5.0


@rule("min-feature")
def min_feature(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a pin or a rod that breaks off, or that a slicer leaves out.

    A place counts where it is thinner than the profile's minimum feature in both directions across.
    """
    limit = FACETED * profile.min_feature_mm
    thin = context.thin_below(FACETED * max(profile.min_feature_mm, profile.wall_mm))
    rods = thin.only((thin.thick_mm < limit) & (thin.wide_mm < profile.min_feature_mm))
    if rods.total_mm2 < LEAST_MM2:
        return
    least, place = rods.thinnest
    yield finding(
        "min-feature",
        f"A pin or rod is {least:.2f} mm thick; it should be {profile.min_feature_mm:g} mm "
        f"({rods.total_mm2:.0f} mm² of surface).",
        "Make it thicker, or scale the model up (--size).",
        value=least,
        limit=profile.min_feature_mm,
        at_mm=place,
        area_mm2=rods.total_mm2,
    )
