"""What vaults are built of: how steep, how thick, how slender; and the volume of a column.

Notation: θ steepest overhang from the vertical, m least thickness across an axis, ℓ length of the
longest way up from a place to a tip, φ lean of a column, S slenderness.

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
    from printprep.arrays import Float
    from printprep.profiles import Profile

# Slicers thin out their outlines, PrusaSlicer by its resolution; so much less reach is built for.
# (Without it 0.46 g of support were printed in a cow's cavity that the rule itself accepted.)
RESOLUTION_MM = 0.0125
# Below a joint a column narrows to its own section, a fifth of its radius over 2 mm or more
# (solids.py), and there leans out so much farther than its axis does.
JOINT_TAN = 0.06


def built_for(profile: Profile) -> Acceptance:
    """The slicer's rule with the reserve.  Raises UsageError where there is no nozzle."""
    rule = acceptance(profile)
    return replace(rule, off_mm=rule.off_mm - RESOLUTION_MM)


def slope_deg(profile: Profile) -> float:
    """The lean of a ceiling, from the vertical, from which it is carried at once.

    Along an even slope the rule grants tan θ = off / h, and c less only where a void closes.  Most
    slopes between end in a wall and pass; carrying them all would add a tenth to the vaults.  The
    few that do close are found by the rule, and mended.
    """
    return min(math.degrees(math.atan(_slope_tan(built_for(profile)))), profile.overhang_deg)


def _slope_tan(rule: Acceptance) -> float:
    return max(rule.off_mm - rule.closing_mm / 4, 0.0) / rule.layer_mm


@dataclass(frozen=True)
class Members:
    """theta_deg : how far a funnel widens, from the vertical;  lean_deg : how far a column leans;
    thickness_mm : least, across any axis;  slenderness : lengths over thickness from which a column
    widens."""

    theta_deg: float
    lean_deg: float
    thickness_mm: float
    slenderness: float

    @staticmethod
    def of(profile: Profile) -> Members:
        """As the profile asks.  Raises UsageError where it has no nozzle."""
        rule, cap_deg = built_for(profile), profile.overhang_deg
        lean_deg = math.degrees(math.atan(_slope_tan(rule) - JOINT_TAN))
        assert profile.column_slenderness is not None
        return Members(
            theta_deg=min(rule.steepest_deg, cap_deg),
            lean_deg=min(lean_deg, cap_deg),
            thickness_mm=profile.min_feature_mm,
            slenderness=profile.column_slenderness,
        )

    @property
    def tan(self) -> float:
        return math.tan(math.radians(self.theta_deg))

    @property
    def lean_tan(self) -> float:
        return math.tan(math.radians(self.lean_deg))

    @property
    def radius_mm(self) -> float:
        """Of a capital's lower end, and of an upright column's upper end."""
        return self.thickness_mm / 2

    @property
    def leaning_radius_mm(self) -> float:
        """Of the upper end of a column that leans as much as it may."""
        return self.radius_mm / math.cos(math.radians(self.lean_deg))

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
