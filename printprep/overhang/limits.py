"""How far a layer may reach beyond the one below, and the steepest overhang that follows.

Notation: h layer height, w line width, off the reach granted to a layer, c the radius by which
slices are closed first, θ the overhang measured from the vertical.

PrusaSlicer grows the layer below by off and supports what still sticks out: w/2 at the automatic
threshold, h / tan(a + 1°) at a threshold of a degrees (SupportMaterial.cpp, detect_overhangs, read
in version 2.5).  Closing fills wedges narrower than 2c before, so a void that tapers upward at θ
ends c early on each side, all in one layer: what that layer must bridge is h · tan θ + c, and

    tan θ ≤ (off − c) / h.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.profiles import Profile

# PrusaSlicer's slice_closing_radius, its default in every vendor profile.
CLOSING_MM = 0.049
# The threshold that users set by hand, and the degree that the slicer adds to it.
THRESHOLD_DEG = 45.0
ADDED_DEG = 1.0
# Kept from the limit: polygons for arcs, and coordinates of single precision.
SLACK_DEG = 0.25


@dataclass(frozen=True)
class Acceptance:
    """A slicer's rule: layers, how far each may reach, and how slices are closed before.

    Layer 0 spans z = 0 to ``first_layer_mm``, the others follow at ``layer_mm``; each is cut at its
    middle.
    """

    layer_mm: float
    first_layer_mm: float
    off_mm: float
    closing_mm: float = CLOSING_MM

    @property
    def steepest_deg(self) -> float:
        """Largest θ of a ceiling that the rule accepts however its facets meet the layers."""
        return math.degrees(math.atan(max(self.off_mm - self.closing_mm, 0.0) / self.layer_mm))


def acceptance(profile: Profile) -> Acceptance:
    """The stricter of PrusaSlicer's rules at its automatic threshold and at 45°.

    Raises UsageError for a profile without a nozzle: nothing is extruded, so nothing sags.
    """
    printer = profile.printer
    if printer.line_width_mm is None:
        raise UsageError(
            f"profile {profile.name} is for {profile.process}: it has no overhang rule",
            "choose an fdm profile",
        )
    automatic = printer.line_width_mm / 2
    by_angle = printer.layer_height_mm / math.tan(math.radians(THRESHOLD_DEG + ADDED_DEG))
    return Acceptance(printer.layer_height_mm, printer.first_layer_mm, min(automatic, by_angle))


def steepest_overhang_deg(profile: Profile) -> float:
    """The overhang to build to, from the vertical: what both rules accept, and the profile's cap.

    35.5° at layers of 0.2 mm and lines of 0.45 mm, of which 0.25° are kept from the limit itself.
    """
    return min(acceptance(profile).steepest_deg - SLACK_DEG, profile.overhang_deg)
