"""Rule: walls are as thick as the profile asks for, around cavities and everywhere else."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

TOLERANCE_MM = 0.05
# Less surface than this is an edge that was rounded off, or the tip of a fold.
LEAST_MM2 = 5.0
# What is round is made of facets: a pin of eight sides is 8 % thinner across its flats.
FACETED = 0.9
# Below this share of the profile's wall there is hardly a line of it left.
HARDLY = 0.5


@rule("wall-thickness")
def wall_thickness(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a wall that prints with holes, or breaks when the part is touched.

    Around cavities it is the exact distance of the finished surfaces, and an error.  What is thin
    by design, a fin or an ear, is told: as a warning where less than half the wall is left.
    """
    wall = context.wall
    if wall is not None and wall.value_mm < profile.wall_mm - TOLERANCE_MM:
        if context.hollowed:
            fix = "Hollow it with a finer grid (--resolution), or report the model as a defect."
        else:
            fix = "Hollow the solid model again with this wall, or name the wall meant with --wall."
        yield finding(
            "wall-thickness",
            f"The thinnest wall between a cavity and the outside is {wall.value_mm:.2f} mm, "
            f"the profile asks for {profile.wall_mm:g} mm.",
            fix,
            severity="error",
            value=wall.value_mm,
            limit=profile.wall_mm,
            at_mm=wall.at_mm,
            area_mm2=context.thin_below(FACETED * profile.wall_mm).total_mm2,
        )
    else:
        yield from _fins(context, profile)


def _fins(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    thin = context.thin_below(FACETED * profile.wall_mm)
    # What lies on the bed prints whole however thin it is.
    lying = thin.middle[:, 2] < thin.thick_mm / 2 + profile.printer.first_layer_mm
    fins = thin.only((thin.wide_mm >= profile.min_feature_mm) & ~lying)
    if fins.total_mm2 < LEAST_MM2:
        return
    hardly = fins.only(fins.thick_mm < HARDLY * FACETED * profile.wall_mm)
    told = hardly if hardly.total_mm2 >= LEAST_MM2 else fins
    least, place = told.thinnest
    bound = HARDLY * profile.wall_mm if told is hardly else profile.wall_mm
    yield finding(
        "wall-thickness",
        f"{told.total_mm2:.0f} mm² of its surface stand on walls thinner than {bound:g} mm, the "
        f"thinnest {least:.2f} mm.",
        "Thicken these places, scale the model up (--size), or take care of them.",
        severity="warning" if told is hardly else "info",
        value=least,
        limit=bound,
        at_mm=place,
        area_mm2=told.total_mm2,
    )
