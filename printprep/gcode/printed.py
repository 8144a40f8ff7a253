"""What a G-code prints, as far as mass and balance go."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.arrays import Float


@dataclass(frozen=True)
class SlicerSummary:
    """What the slicer wrote into the file of itself and its settings; None where it did not.

    producer : name and version;  filament_mm3, filament_g : of all extruders, by its own count;
    seconds : its estimate of the printing time;  settings : its "key = value" comments.
    """

    producer: str | None
    filament_mm3: float | None
    filament_g: float | None
    seconds: float | None
    settings: Mapping[str, str]


@dataclass(frozen=True, eq=False)
class Balance:
    """How a print, or one body of it, stands; as ``Printed`` says.

    Without contact with the bed the polygon is empty and ``tilt_deg`` None.
    """

    mass_g: float
    centre_of_mass_mm: tuple[float, float, float]
    contact_polygon_mm: Float
    contact_area_mm2: float
    tilt_deg: float | None


@dataclass(frozen=True, eq=False)
class Printed:
    """Measured from the moves; mm of the machine, heights above the underside of the lowest layer.

    mass_g, volume_mm3, centre_of_mass_mm, inertia_g_mm2 : of what stays of the print
    (``left_out`` names what does not); the inertia, (3, 3), is about the centre of mass.
    contact_polygon_mm : (k, 2) counter-clockwise hull of the first layer, each bead as wide as the
    file says;  contact_area_mm2 : of the beads' union.
    tilt_deg : the lean at which it tips over the weakest edge, negative when it tips by itself.
    bodies : each by itself, in the order they were given; empty where none were.
    feature_mass_g, feature_volume_mm3 : by feature, what is left out too.
    bounds_mm : (2, 3) low and high corners of what stays, whole beads; z of the machine.
    objects : labels of the objects printed, where the file labels them.
    filament_mm3 : all of it but custom G-code: what slicers count as filament used.
    in_cavities_mm3, support_in_cavities_mm3 : deposited inside the cavities given, and the support
    among it;  in_cavities_at_mm : a place of the first, or None.
    assumed : what the file does not say and was taken for granted, one sentence each.
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
    slicer_summary: SlicerSummary
