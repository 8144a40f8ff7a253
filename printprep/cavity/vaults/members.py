"""What vaults are built of: how steep, how thick, how slender; and the volume of a column.

Notation: θ steepest overhang from the vertical, m least thickness across an axis, ℓ length of the
longest way up from a place to a tip, φ ≤ θ lean of a column, S slenderness.

A column is round across its axis, t(ℓ) thick.  Cut level it reaches t(ℓ) / (2 cos φ) toward its
lean.

Until its tip reaches the ceiling a column is a cantilever that the nozzle drags at with a force
that does not depend on it.  Its end gives way by ℓ³ / t⁴ times a constant, so the thickness that
keeps it as stiff as one of thickness m and length S m is

    t(ℓ) = m max(1, ℓ / (S m))^(3/4).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.overhang.limits import Acceptance, acceptance

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Float

# Our choice, from how slicers' tree supports widen: 5° of diameter over length is 1/11.5 of it.
SLENDERNESS = 12.0
# Slicers thin out their outlines, PrusaSlicer by its resolution; so much less reach is built for.
# (Without it 0.46 g of support were printed in a cow's cavity that the rule itself accepted.)
RESOLUTION_MM = 0.0125


def built_for(profile: Profile) -> Acceptance:
    """The slicer's rule with the reserve.  Raises UsageError where there is no nozzle."""
    rule = acceptance(profile)
    return replace(rule, off_mm=rule.off_mm - RESOLUTION_MM)


@dataclass(frozen=True)
class Members:
    """theta_deg : steepest overhang from the vertical;  thickness_mm : least, across any axis."""

    theta_deg: float
    thickness_mm: float
    slenderness: float = SLENDERNESS

    @staticmethod
    def of(profile: Profile) -> Members:
        """As the profile asks.  Raises UsageError where it has no nozzle."""
        theta_deg = min(built_for(profile).steepest_deg, profile.overhang_deg)
        return Members(theta_deg, profile.min_feature_mm)

    @property
    def tan(self) -> float:
        return math.tan(math.radians(self.theta_deg))

    @property
    def radius_mm(self) -> float:
        """Of a capital's lower end, and of an upright column's upper end."""
        return self.thickness_mm / 2

    @property
    def leaning_radius_mm(self) -> float:
        """Of the upper end of a column that leans as much as it may."""
        return self.radius_mm / math.cos(math.radians(self.theta_deg))

    def across_mm(self, length_mm: Float) -> Float:
        """Half the thickness across the axis, a length below the farthest tip."""
        share = np.maximum(np.asarray(length_mm) / (self.slenderness * self.thickness_mm), 1.0)
        half: Float = self.radius_mm * share**0.75
        return half

    def volume_mm3(self, above_mm: Float | float, length_mm: Float | float) -> Float:
        """Of columns ``length_mm`` long that carry a tree of ``above_mm``."""
        above: Float = np.asarray(above_mm, dtype=np.float64)
        result: Float = self._from_tip(above + length_mm) - self._from_tip(above)
        return result

    def _from_tip(self, length: Float) -> Float:
        slender = self.slenderness * self.thickness_mm
        wide = slender * (np.maximum(length / slender, 1.0) ** 2.5 - 1) / 2.5
        result: Float = math.pi * self.radius_mm**2 * (np.minimum(length, slender) + wide)
        return result
