"""The differences between a print and the computed part, as findings.

Within the tolerances, the computed figures still hold: the lean is solved with a margin, and a
slicer rounds beads and layers.
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
CENTRE_MM, CENTRE_SHARE = 0.5, 0.01  # the share is of the height; the larger one counts
LEAN_DEG = 1.0
CONTACT_MM = 0.5  # about a line
FILAMENT_SHARE = 0.005

_SETTINGS = "Slice it with the profile's settings (`printprep profiles export`)."


def compare(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    """Where a print differs from its part by more than the tolerances."""
    yield from _mass(part, printed)
    yield from _centre(part, printed)
    yield from _contact(part, printed)
    yield from _tilt(part, printed)
    yield from _cavities(printed)
    yield from _filament(printed)


def support_inside(printed: Printed) -> Iterator[Finding]:
    """Whether a print with supports has supports inside cavities."""
    inside_mm3 = printed.support_in_cavities_mm3
    if inside_mm3 > 0:
        yield finding(
            "support-in-cavity",
            f"With supports switched on, the slicer prints {inside_mm3 / 1000:.2g} cm³ of them "
            "inside cavities.",
            "Set the slicer's supports to start on the build plate only.",
            value=inside_mm3,
            limit=0.0,
            at_mm=printed.in_cavities_at_mm,
        )


def centre_offset_mm(part: ComputedPart, printed: Printed) -> float:
    """Distance between the computed and the printed centre of mass."""
    return float(np.linalg.norm(np.array(printed.centre_of_mass_mm) - part.centre_mm))


def contact_offset_mm(part: ComputedPart, printed: Printed) -> float | None:
    """How far the printed support polygon reaches beyond the computed one, or falls short of it.

    This is the Hausdorff distance of convex sets, except that contact narrower than a line may be
    missing in the print.  None if the part has no contact.
    """
    if not len(part.contact_polygon_mm):
        return None
    printed_reach = _reach(printed.contact_polygon_mm)
    beyond = printed_reach - _reach(part.contact_polygon_mm)
    sure = part.sure_polygon_mm
    short = _reach(sure) - printed_reach if len(sure) else np.zeros(1)
    return float(max(beyond.max(), short.max(), 0.0))


def _reach(polygon_mm: Float) -> Float:
    """How far a convex polygon, (k, 2) mm, reaches in each direction: (360,) mm, by degrees."""
    angles = np.radians(np.arange(0.0, 360.0, 1.0))
    reach: Float = (polygon_mm @ np.stack([np.cos(angles), np.sin(angles)])).max(axis=0)
    return reach


def _mass(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    share = printed.mass_g / part.mass_g - 1
    if abs(share) > MASS_SHARE:
        yield finding(
            "printed-mass",
            f"The print weighs {printed.mass_g:.1f} g, {abs(share):.0%} "
            f"{'more' if share > 0 else 'less'} than the computed {part.mass_g:.1f} g.",
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
            f"The centre of mass of the print is {offset:.2f} mm away from the computed one.",
            _SETTINGS,
            value=offset,
            limit=limit,
            at_mm=(x, y, z),
        )


def centre_limit_mm(part: ComputedPart) -> float:
    """How far the printed centre of mass may be from the computed one."""
    return max(CENTRE_MM, CENTRE_SHARE * float(part.size_mm[2]))


def _contact(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    offset = contact_offset_mm(part, printed)
    if offset is not None and offset > CONTACT_MM:
        yield finding(
            "printed-contact",
            f"The support polygon of the print differs by {offset:.2f} mm from the computed one.",
            "Slice it with the profile's first layer and line width, and without elephant foot "
            "compensation.",
            value=offset,
            limit=CONTACT_MM,
        )


def _tilt(part: ComputedPart, printed: Printed) -> Iterator[Finding]:
    # Where the lean is out of reach, the part promises only its own tilt angle.
    promised = -90.0 if part.tilt_deg is None else min(part.lean.angle_deg, part.tilt_deg)
    bodies = len(part.bodies)
    yield from printed_tilt(
        printed,
        part.lean,
        promised_deg=promised,
        tolerance_deg=LEAN_DEG,
        subject="the print" if bodies == 1 else f"the weakest of its {bodies} bodies",
        fix=f"{_SETTINGS} Or hollow it with a larger margin (--set stability.lean_margin_deg=2).",
    )


def printed_tilt(
    printed: Printed,
    lean: Lean,
    *,
    promised_deg: float,
    tolerance_deg: float = 0.0,
    subject: str = "the print",
    fix: str,
) -> Iterator[Finding]:
    """Whether a print tips over at less than the promised lean, or falls over by itself."""
    tilt = tilt_as_printed(printed, lean)
    if tilt >= promised_deg - tolerance_deg and not tilt < 0 <= promised_deg:
        return
    falls = "falls over by itself" if tilt < 0 else f"tips over at {tilt:.1f}°"
    yield finding(
        "printed-tilt",
        f"As printed, {subject} {falls}; it should stand at {lean}.",
        fix,
        value=tilt,
        limit=promised_deg,
    )


def _cavities(printed: Printed) -> Iterator[Finding]:
    if printed.in_cavities_mm3 > 0:
        yield finding(
            "filled-cavity",
            f"The slicer prints {printed.in_cavities_mm3 / 1000:.2g} cm³ inside cavities.",
            "Do not let the slicer close holes or repair the part (slicing mode: regular).",
            value=printed.in_cavities_mm3,
            limit=0.0,
            at_mm=printed.in_cavities_at_mm,
        )


def _filament(printed: Printed) -> Iterator[Finding]:
    """Whether the moves in the G-code add up to the filament that the slicer counts."""
    counted = printed.slicer_summary.filament_mm3
    # Slicers round to 0.01 cm³.
    if counted and abs(printed.filament_mm3 - counted) > max(FILAMENT_SHARE * counted, 10.0):
        yield finding(
            "filament-count",
            f"The slicer counts {counted / 1000:.2f} cm³ of filament, but the moves add up to "
            f"{printed.filament_mm3 / 1000:.2f} cm³.",
            "Treat the figures of this print as uncertain by as much. Start G-code that prints is "
            "one cause.",
            value=printed.filament_mm3,
            limit=counted,
        )
