"""The results of measuring a G-code: mass, balance, contact, and the slicer's own summary."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.arrays import Float


@dataclass(frozen=True)
class SlicerSummary:
    """What the slicer's comments tell about the print; None where they do not.

    producer : name and version of the slicer;  filament_mm3, filament_g : its sums over all
    extruders;  seconds : its estimate of the printing time;  settings : "key = value" comments.
    """

    producer: str | None
    filament_mm3: float | None
    filament_g: float | None
    seconds: float | None
    settings: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Balance:
    """How a print, or one body of it, stands; the fields are those of ``Printed``.

    contact_polygon_mm : (k, 2).  Without contact with the bed it is empty and ``tilt_deg`` is None.
    """

    mass_g: float
    centre_of_mass_mm: tuple[float, float, float]
    contact_polygon_mm: Float
    contact_area_mm2: float
    tilt_deg: float | None


@dataclass(frozen=True, eq=False)
class Printed:
    """A print as measured from its moves, in mm of the machine.

    Heights count from the underside of the lowest layer, except in ``bounds_mm``.

    mass_g, volume_mm3, centre_of_mass_mm, inertia_g_mm2 : of the print without the features in
    ``left_out``; the inertia, (3, 3), is about the centre of mass.
    contact_polygon_mm : (k, 2) counter-clockwise hull of the first layer, with beads as wide as the
    file gives;  contact_area_mm2 : of the union of the beads.
    tilt_deg : the lean at which it tips over the weakest edge, negative when it tips by itself.
    bodies : each body by itself, in the order given; empty where none were given.
    feature_mass_g, feature_volume_mm3 : by feature, those in ``left_out`` too.
    bounds_mm : (2, 3) low and high corners of whole beads, without ``left_out``; z of the machine.
    objects : labels of the objects printed, where the file labels them.
    filament_mm3 : all but custom G-code, as slicers count the filament used.
    in_cavities_mm3, support_in_cavities_mm3 : deposited inside the cavities given, and the support
    in this;  in_cavities_at_mm : a place of the first, or None.
    assumed : figures that the file does not give, one sentence each.
    labelled : whether the file labels its features; where it does not, skirt, brim and supports
    cannot be told from the model, and count as part of it.
    """

    mass_g: float
    volume_mm3: float
    centre_of_mass_mm: tuple[float, float, float]
    inertia_g_mm2: Float
    contact_polygon_mm: Float
    contact_area_mm2: float
    tilt_deg: float
    bodies: tuple[Balance, ...]
    feature_mass_g: Mapping[str, float]
    feature_volume_mm3: Mapping[str, float]
    left_out: tuple[str, ...]
    bounds_mm: Float
    objects: tuple[str, ...]
    filament_mm3: float
    in_cavities_mm3: float
    support_in_cavities_mm3: float
    in_cavities_at_mm: tuple[float, float, float] | None
    assumed: tuple[str, ...]
    labelled: bool
    slicer_summary: SlicerSummary
