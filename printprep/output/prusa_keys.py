"""PrusaSlicer's keys for an infill print: those of the object, and those of its ballast.

Walls are made of lines: the first adds a line's width, each further one a spacing, which is less
because the sides of a bead are round (Slic3r's flow math: spacing = width − height · (1 − π/4)).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.profiles import Profile

# The keys of a ballast modifier: dense, with lines that touch (only the rectilinear pattern does).
DENSE = {"fill_density": "100%", "fill_pattern": "rectilinear"}
# The keys of a part with columns.  A slicer slows down every loop shorter than 41 mm, as each layer
# of a column is, to a quarter of the speed of perimeters (PrusaSlicer's default: 15 of 60 mm/s).
# Three fifths of it are about the speed of outer walls (half in the defaults, 25 of 45 and 35 of
# 60 mm/s in PrusaResearch.ini), so that nothing outside prints faster than an outer wall.
FOR_COLUMNS: Mapping[str, str] = {"small_perimeter_speed": "60%"}
# PrusaSlicer's snug supports close gaps between their pieces that are narrower than twice this.
_CLOSING_MM = 2.0
# Keeps a slicer's supports out of cavities, so an infill print does not need it.
_FOR_CAVITIES = "support_material_buildplate_only"


def lines(profile: Profile) -> int:
    """Number of perimeters: the profile's, or the least that are no thinner than its wall."""
    width_mm = profile.printer.line_width_mm
    assert width_mm is not None  # an fdm profile has one
    requested = None if profile.infill is None else profile.infill.perimeters
    return _count(profile.wall_mm, width_mm) if requested is None else requested


def layers(profile: Profile) -> int:
    """Number of solid layers at top and bottom: the least that are no thinner than the wall."""
    return _count(profile.wall_mm, profile.printer.layer_height_mm)


def wall_keys(profile: Profile) -> dict[str, str]:
    """The slicer's keys for walls as thick as the profile's wall."""
    return {
        "perimeters": str(lines(profile)),
        "top_solid_layers": str(layers(profile)),
        "bottom_solid_layers": str(layers(profile)),
    }


def object_keys(profile: Profile) -> dict[str, str]:
    """All keys of an object that is printed with the profile's infill."""
    assert profile.infill is not None  # see :func:`printprep.infill.options.check_infill`
    kept = {
        key: value for key, value in profile.slicer.object_settings.items() if key != _FOR_CAVITIES
    }
    return {
        **kept,
        **wall_keys(profile),
        "fill_density": f"{100 * profile.infill.density:g}%",
        "fill_pattern": profile.infill.pattern,
    }


def blocker_keys(profile: Profile) -> dict[str, str]:
    """The keys of a part with a support blocker.

    Snug supports on both sides of a limb would close over it, and so be printed in its cavity too.
    They do not where they close less than the two walls that are between.
    """
    return {"support_material_closing_radius": f"{min(_CLOSING_MM, profile.wall_mm):g}"}


def without_columns(settings: Mapping[str, str]) -> dict[str, str]:
    """Settings as a model without columns gets them."""
    return {key: value for key, value in settings.items() if FOR_COLUMNS.get(key) != value}


def walls_mm(profile: Profile) -> tuple[float, float]:
    """Thickness of the slicer's walls in mm: sideways, of lines, and upward, of layers."""
    width_mm, layer_mm = profile.printer.line_width_mm, profile.printer.layer_height_mm
    assert width_mm is not None  # an fdm profile has one
    spacing_mm = width_mm - layer_mm * (1 - math.pi / 4)
    return width_mm + (lines(profile) - 1) * spacing_mm, layers(profile) * layer_mm


def _count(thick_mm: float, each_mm: float) -> int:
    return math.ceil(thick_mm / each_mm - 1e-6)
