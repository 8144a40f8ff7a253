"""Rule: walls are at least as thick as the profile's wall, around cavities and elsewhere."""

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
# Less surface than this is a rounded edge, or the tip of a fold.
LEAST_MM2 = 5.0
# Round shapes are made of facets: a pin with eight sides is 8 % thinner across its flats.
FACETED = 0.9
# Below this share of the profile's wall, little more than one printed line is left.
VERY_THIN = 0.5


@rule("wall-thickness")
def wall_thickness(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a wall that prints with holes, or breaks when the part is touched.

    Around cavities it is an error, and the wall is the exact distance between the finished
    surfaces.  What is thin by design, such as a fin or an ear, is information, or a warning where
    it is thinner than half the profile's wall.
    """
    wall = context.wall
    if wall is not None and wall.value_mm < profile.wall_mm - TOLERANCE_MM:
        if context.hollowed:
            fix = "Hollow it with a finer grid (--resolution), or report the model to printprep."
        else:
            fix = (
                f"Hollow the solid model with a wall of {profile.wall_mm:g} mm, or name the "
                "intended wall (--wall)."
            )
        yield finding(
            "wall-thickness",
            f"The thinnest wall between a cavity and the outside is {wall.value_mm:.2f} mm; it "
            f"should be {profile.wall_mm:g} mm.",
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
    # What lies flat on the bed prints well, however thin it is.
    lying = thin.middle[:, 2] < thin.thick_mm / 2 + profile.printer.first_layer_mm
    fins = thin.only((thin.wide_mm >= profile.min_feature_mm) & ~lying)
    if fins.total_mm2 < LEAST_MM2:
        return
    very_thin = fins.only(fins.thick_mm < VERY_THIN * FACETED * profile.wall_mm)
    reported = very_thin if very_thin.total_mm2 >= LEAST_MM2 else fins
    least, place = reported.thinnest
    bound = VERY_THIN * profile.wall_mm if reported is very_thin else profile.wall_mm
    yield finding(
        "wall-thickness",
        f"{reported.total_mm2:.0f} mm² of the surface are on walls thinner than {bound:g} mm; the "
        f"thinnest is {least:.2f} mm.",
        "Make these places thicker, scale the model up (--size), or handle them with care.",
        severity="warning" if reported is very_thin else "info",
        value=least,
        limit=bound,
        at_mm=place,
        area_mm2=reported.total_mm2,
    )
