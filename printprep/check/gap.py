"""Rule: what is meant to stay apart is far enough apart."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.subject import Subject
    from printprep.profiles import Profile

TOLERANCE_MM = 0.01
# Two sides of a gap this small are a fold.
LEAST_MM2 = 5.0


@rule("gap")
def gap(subject: Subject, profile: Profile) -> Iterator[Finding]:
    """Prevents two surfaces from growing together: a hinge that sticks, letters that fill up.

    Sides that are nearly parallel only; where surfaces meet in a crease nothing is lost.
    """
    limit = profile.min_gap_mm
    if limit is None:
        return
    narrow = subject.narrow_below(limit - TOLERANCE_MM)
    if narrow.total_mm2 < LEAST_MM2:
        return
    least, place = narrow.thinnest
    yield Finding(
        "gap",
        "info",
        f"A gap of {least:.2f} mm may print closed: the profile asks for {limit:g} mm "
        f"({narrow.total_mm2:.0f} mm² of its sides).",
        "Widen the gap, or join what it parts.",
        value=least,
        limit=limit,
        unit="mm",
        at_mm=place,
        area_mm2=narrow.total_mm2,
    )
