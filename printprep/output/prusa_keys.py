"""An infill print in the slicer's words: what the object carries, and what its ballast does.

Walls are lines: the first as wide as a line, each further one closer by the corners that a bead's
round sides leave (Slic3r's flow math: spacing = width − height · (1 − π/4)).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.profiles import Profile

# Of a modifier's volume: dense, and so that neighbouring lines touch (slicer's rectilinear only)
DENSE = {"fill_density": "100%", "fill_pattern": "rectilinear"}
# Only a part with cavities has to keep a slicer's supports out of them.
_FOR_CAVITIES = "support_material_buildplate_only"


def lines(profile: Profile) -> int:
    """Perimeters: the profile's, else the least that are no thinner than its wall."""
    width_mm = profile.printer.line_width_mm
    assert width_mm is not None  # an fdm profile has one
    asked = None if profile.infill is None else profile.infill.perimeters
    return _count(profile.wall_mm, width_mm) if asked is None else asked


def layers(profile: Profile) -> int:
    """Solid layers at top and bottom: the least that are no thinner than the profile's wall."""
    return _count(profile.wall_mm, profile.printer.layer_height_mm)


def wall_keys(profile: Profile) -> dict[str, str]:
    """The slicer's keys for walls as thick as the profile's."""
    return {
        "perimeters": str(lines(profile)),
        "top_solid_layers": str(layers(profile)),
        "bottom_solid_layers": str(layers(profile)),
    }


def object_keys(profile: Profile) -> dict[str, str]:
    """All that an object printed with the profile's infill carries."""
    assert profile.infill is not None  # see :func:`printprep.infill.options.check_fill`
    kept = {
        key: value for key, value in profile.slicer.object_settings.items() if key != _FOR_CAVITIES
    }
    return {
        **kept,
        **wall_keys(profile),
        "fill_density": f"{100 * profile.infill.density:g}%",
        "fill_pattern": profile.infill.pattern,
    }


def walls_mm(profile: Profile) -> tuple[float, float]:
    """How thick the slicer's walls are: across, of lines, and upward, of layers."""
    width_mm, layer_mm = profile.printer.line_width_mm, profile.printer.layer_height_mm
    assert width_mm is not None  # an fdm profile has one
    spacing_mm = width_mm - layer_mm * (1 - math.pi / 4)
    return width_mm + (lines(profile) - 1) * spacing_mm, layers(profile) * layer_mm


def _count(thick_mm: float, each_mm: float) -> int:
    return math.ceil(thick_mm / each_mm - 1e-6)
