"""Rule: no wall between a cavity and the outside is thinner than the profile's."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.subject import Subject
    from printprep.profiles import Profile

TOLERANCE_MM = 0.05


@rule("wall-thickness")
def wall_thickness(subject: Subject, profile: Profile) -> Iterator[Finding]:
    """Prevents a wall that prints with holes, or breaks when the part is touched.

    Measured on the finished surfaces, not assumed from the field they were cut from.
    """
    wall = subject.wall
    if wall is None or wall.value_mm >= profile.wall_mm - TOLERANCE_MM:
        return
    if subject.hollowed:
        fix = "Hollow it with a finer grid (--resolution), or report the model as a defect."
    else:
        fix = "Hollow the solid model again with this wall, or name the wall meant with --wall."
    yield Finding(
        "wall-thickness",
        "error",
        f"The thinnest wall between a cavity and the outside is {wall.value_mm:.2f} mm, "
        f"the profile asks for {profile.wall_mm:g} mm.",
        fix,
        value=wall.value_mm,
        limit=profile.wall_mm,
        unit="mm",
        at_mm=wall.at_mm,
    )
