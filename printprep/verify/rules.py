"""Where a print differs from what was computed, as findings.

Tolerances are those within which the part's own claims stay true: the lean is solved for with a
margin, and a slicer rounds beads and layers.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.gcode.stability import tilt_as_printed
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.gcode.printed import Printed
    from printprep.types import Lean
    from printprep.verify.part_3mf import ComputedPart


MASS_SHARE = 0.04
CENTRE_MM, CENTRE_SHARE = 0.5, 0.01  # of the height, if that is more
LEAN_DEG = 1.0
CONTACT_MM = 0.5  # a line
FILAMENT_SHARE = 0.005

_SETTINGS = "Slice it with the profile's settings: `printprep profiles export`."


def compare(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    """What differs between a part and a print of it, by more than the tolerances."""
    yield from _mass(part, printed)
    yield from _centre(part, printed)
    yield from _contact(part, printed)
    yield from _tilt(part, printed)
    yield from _cavities(printed)
    yield from _own_count(printed)


def support_inside(printed: Printed) -> Iterator[Finding]:
    """Whether supports, switched on, go where nobody gets them out."""
    inside_mm3 = printed.support_in_cavities_mm3
    if inside_mm3 > 0:
        yield finding(
            "support-in-cavity",
            f"With supports switched on, {inside_mm3 / 1000:.2g} cm³ of them fill cavities.",
            "Let supports start from the build plate only.",
            value=inside_mm3,
            limit=0.0,
            at_mm=printed.in_cavities_at_mm,
        )


def centre_offset_mm(part: ComputedPart, printed: Printed) -> float:
    """Distance between the centres of mass, computed and printed."""
    return float(np.linalg.norm(np.array(printed.centre_of_mass_mm) - part.centre_mm))


def contact_offset_mm(part: ComputedPart, printed: Printed) -> float | None:
    """How far the printed support polygon reaches beyond the computed one, or falls short of it.

    Hausdorff's distance of convex sets, but that what is narrower than a line need not be there.
    """
    if not len(part.contact_polygon_mm):
        return None
    printed_reach = _reach(printed.contact_polygon_mm)
    beyond = printed_reach - _reach(part.contact_polygon_mm)
    sure = part.sure_polygon_mm
    short = _reach(sure) - printed_reach if len(sure) else np.zeros(1)
    return float(max(beyond.max(), short.max(), 0.0))


def _reach(polygon_mm: Float) -> Float:
    """(360,) how far a convex polygon reaches toward every degree."""
    angles = np.radians(np.arange(0.0, 360.0, 1.0))
    reach: Float = (polygon_mm @ np.stack([np.cos(angles), np.sin(angles)])).max(axis=0)
    return reach


def _mass(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    share = printed.mass_g / part.mass_g - 1
    if abs(share) > MASS_SHARE:
        yield finding(
            "printed-mass",
            f"The print weighs {printed.mass_g:.1f} g, {abs(share):.0%} "
            f"{'more' if share > 0 else 'less'} than the {part.mass_g:.1f} g computed.",
            _SETTINGS,
            value=printed.mass_g,
            limit=part.mass_g,
        )


def _centre(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    offset, limit = centre_offset_mm(part, printed), centre_limit_mm(part)
    if offset > limit:
        x, y, z = printed.centre_of_mass_mm
        yield finding(
            "printed-centre-of-mass",
            f"The print's centre of mass lies {offset:.2f} mm from the one computed.",
            _SETTINGS,
            value=offset,
            limit=limit,
            at_mm=(x, y, z),
        )


def centre_limit_mm(part: ComputedPart) -> float:
    """How far the centres may lie apart."""
    return max(CENTRE_MM, CENTRE_SHARE * float(part.size_mm[2]))


def _contact(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    offset = contact_offset_mm(part, printed)
    if offset is not None and offset > CONTACT_MM:
        yield finding(
            "printed-contact",
            f"The first layer's outline differs by {offset:.2f} mm from the one computed.",
            "Print it with the profile's first layer, line width and no elephant foot "
            "compensation.",
            value=offset,
            limit=CONTACT_MM,
        )


def _tilt(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    asked = part.lean.angle_deg
    # Where the lean is out of reach, the part promises only the tilt it has
    promised = -90.0 if part.tilt_deg is None else min(asked, part.tilt_deg)
    bodies = len(part.bodies)
    yield from printed_tilt(
        printed,
        part.lean,
        promised_deg=promised,
        tolerance_deg=LEAN_DEG,
        what="the print" if bodies == 1 else f"the weakest of its {bodies} bodies",
        fix=f"{_SETTINGS} A larger lean margin helps too: --set stability.lean_margin_deg=2.",
    )


def printed_tilt(
    printed: Printed,
    lean: Lean,
    *,
    promised_deg: float,
    tolerance_deg: float = 0.0,
    what: str = "the print",
    fix: str,
) -> Iterator[Finding]:
    """Whether a print tips before a promised lean, or falls over by itself against the promise."""
    tilt = tilt_as_printed(printed, lean)
    if tilt >= promised_deg - tolerance_deg and not tilt < 0 <= promised_deg:
        return
    falls = "falls over by itself" if tilt < 0 else f"tips over at {tilt:.1f}°"
    yield finding(
        "printed-tilt",
        f"As printed, {what} {falls}; it should stand {lean}.",
        fix,
        value=tilt,
        limit=promised_deg,
    )


def _cavities(printed: Printed) -> Iterator[Finding]:
    if printed.in_cavities_mm3 > 0:
        yield finding(
            "filled-cavity",
            f"The slicer prints {printed.in_cavities_mm3 / 1000:.2g} cm³ inside cavities.",
            "Do not close holes or repair the model in the slicer (slicing mode: regular).",
            value=printed.in_cavities_mm3,
            limit=0.0,
            at_mm=printed.in_cavities_at_mm,
        )


def _own_count(printed: Printed) -> Iterator[Finding]:
    """The reader's own test: what it adds up is what the slicer counted."""
    counted = printed.slicer_summary.filament_mm3
    # Slicers round to 0.01 cm³
    if counted and abs(printed.filament_mm3 - counted) > max(FILAMENT_SHARE * counted, 10.0):
        yield finding(
            "filament-count",
            f"The slicer counts {counted / 1000:.2f} cm³ of filament, the moves add up to "
            f"{printed.filament_mm3 / 1000:.2f} cm³.",
            "Figures of this print are uncertain by as much; start G-code that prints is one "
            "cause.",
            value=printed.filament_mm3,
            limit=counted,
        )
