"""How far a layer may reach beyond the one below, and the steepest overhang that follows.

Notation: h layer height, w line width, off how far a layer may reach, c the radius by which
slices are closed first, θ the overhang measured from the vertical.

There are two rules.  The slicer's says where a slicer puts supports; it is made for surfaces that
are seen.  The printer's says what a nozzle lays without sagging: of each line, the share s stands
out over the line below, and the rest lies on it, so off = s w.

PrusaSlicer grows the layer below by off and supports what still reaches beyond it; off is w/2 at
the automatic threshold and h / tan(a + 1°) at a threshold of a degrees (SupportMaterial.cpp,
detect_overhangs, read in version 2.5).  Closing first fills wedges narrower than 2c, so a void that
tapers upward at θ ends c early on each side, all in one layer: that layer must bridge
h · tan θ + c, and

    tan θ ≤ (off − c) / h.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import VaultRule

# PrusaSlicer's slice_closing_radius, the default in every vendor profile.
CLOSING_MM = 0.049
# The threshold that users set by hand, and the degree that the slicer adds to it.
THRESHOLD_DEG = 45.0
ADDED_DEG = 1.0
# Nothing is flatter than this: its tangent bounds every reach.
MOST_DEG = 85.0


@dataclass(frozen=True)
class Acceptance:
    """An overhang rule: the layers, how far each may reach, and how slices are closed.

    Layer 0 spans z = 0 to ``first_layer_mm``, each further layer is ``layer_mm`` high; a layer is
    cut at half its height.
    """

    layer_mm: float
    first_layer_mm: float
    off_mm: float
    closing_mm: float = CLOSING_MM

    @property
    def steepest_deg(self) -> float:
        """Largest θ of a ceiling that the rule accepts wherever the layers cut its facets."""
        return math.degrees(math.atan(max(self.off_mm - self.closing_mm, 0.0) / self.layer_mm))


def slicer_acceptance(profile: Profile) -> Acceptance:
    """The stricter of PrusaSlicer's rules at its automatic threshold and at 45°.

    Raises UsageError for a profile without a nozzle: without extrusion nothing sags.
    """
    printer, width_mm = profile.printer, _line_width_mm(profile)
    automatic = width_mm / 2
    by_angle = printer.layer_height_mm / math.tan(math.radians(THRESHOLD_DEG + ADDED_DEG))
    return Acceptance(printer.layer_height_mm, printer.first_layer_mm, min(automatic, by_angle))


def printer_acceptance(profile: Profile) -> Acceptance:
    """What the printer lays: ``overhang.share`` of a line's width, at most ``overhang_deg``.

    Raises UsageError for a profile without a nozzle: without extrusion nothing sags.
    """
    printer, width_mm = profile.printer, _line_width_mm(profile)
    height_mm = printer.layer_height_mm
    capped = math.tan(math.radians(min(profile.overhang_deg, MOST_DEG))) * height_mm
    off_mm = min(profile.overhang_share * width_mm, capped)
    return Acceptance(height_mm, printer.first_layer_mm, off_mm)


def acceptance(profile: Profile, rule: VaultRule) -> Acceptance:
    """The rule of that name.  Raises UsageError for a profile without a nozzle."""
    return printer_acceptance(profile) if rule == "printer" else slicer_acceptance(profile)


def _line_width_mm(profile: Profile) -> float:
    width_mm = profile.printer.line_width_mm
    if width_mm is None:
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}: it has no overhang rule.",
            "Choose a profile for filament.",
        )
    return width_mm
