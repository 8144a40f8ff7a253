"""How a print stands: the beads of its first layer and its centre of mass, as a ``Stability``."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from printprep.stand.contact import Contact
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import balanced

if TYPE_CHECKING:
    from printprep.gcode.printed import Balance, Printed
    from printprep.types import Lean, Stability


def stability_of_print(printed: Printed | Balance) -> Stability:
    """A print, or one body of it, as a ``Stability``: judged by the same rules as a part."""
    if printed.tilt_deg is None:
        return balanced(None, printed.centre_of_mass_mm)
    contact = Contact(printed.contact_polygon_mm, printed.contact_area_mm2)
    return replace(balanced(contact, printed.centre_of_mass_mm), tilt_deg=printed.tilt_deg)


def tilt_as_printed(printed: Printed, lean: Lean) -> float:
    """The tilt angle in degrees of the weakest body, toward the lean's azimuth if it has one.

    A body that does not touch the bed falls: −90.
    """
    tilts = [tilt_toward(stability_of_print(body), lean) for body in printed.bodies or (printed,)]
    return min(-90.0 if tilt is None else tilt for tilt in tilts)
