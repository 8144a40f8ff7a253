"""How steep, how thick and how slender vaults are, and the volume of their columns.

Notation: θ steepest overhang from the vertical, m least thickness across an axis, ℓ length of the
longest way up from a place to a tip, φ lean of a column, S slenderness.

A column is round across its axis, t(ℓ) thick.  Its level section reaches t(ℓ) / (2 cos φ) toward
its lean.

Until its tip reaches the ceiling, a column is a cantilever.  The nozzle drags at it with a force
that does not depend on it.  Its end yields by ℓ³ / t⁴ times a constant, so the thickness that keeps
it as stiff as a column of thickness m and length S m is

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
    from printprep.types import VaultRule

# Slicers thin out their outlines, PrusaSlicer by its resolution: vaults rely on so much less reach.
# (Without this, a cow's cavity that the rule itself accepts got 0.46 g of support.)
RESOLUTION_MM = 0.0125
# Below a joint a column narrows to its own section, by a fifth of its radius over 2 mm or more
# (solids.py), so its side leans so much farther than its axis.
JOINT_TAN = 0.06
# The exchange rate between time and material: printing a column of any thickness takes as long, per
# mm of its height, as printing so much material elsewhere.  In every layer a column costs travel, a
# retraction and the slow loop around it (docs/self-support.md has the curve).
TIME_MM3_PER_MM = 1.5


def built_for(profile: Profile, rule: VaultRule) -> Acceptance:
    """The rule with the reserve.  Raises UsageError for a profile without a nozzle."""
    accepted = acceptance(profile, rule)
    return replace(accepted, off_mm=accepted.off_mm - RESOLUTION_MM)


def slope_deg(rule: Acceptance, cap_deg: float) -> float:
    """The overhang of a ceiling, from the vertical, beyond which capitals carry all of it.

    Along an even slope the rule allows tan θ = off / h, and c less only where a void closes.  Most
    slopes between the two end in a wall and pass; carrying them all adds a tenth to the vaults.
    The rule finds the few that close, and carry_flagged.py carries them.
    """
    return min(math.degrees(math.atan(_slope_tan(rule))), cap_deg)


def _slope_tan(rule: Acceptance) -> float:
    return max(rule.off_mm - rule.closing_mm / 4, 0.0) / rule.layer_mm


@dataclass(frozen=True)
class MemberSizes:
    """The sizes of funnels and columns.

    theta_deg : how far a funnel widens, from the vertical;  lean_deg : the most a column leans;
    thickness_mm : least, across any axis;  slenderness : length over thickness beyond which a
    column thickens.
    """

    theta_deg: float
    lean_deg: float
    thickness_mm: float
    slenderness: float

    @staticmethod
    def of(profile: Profile, rule: Acceptance) -> MemberSizes:
        """The sizes for a profile with a nozzle, and for a rule with the reserve."""
        cap_deg = profile.overhang_deg
        lean_deg = math.degrees(math.atan(_slope_tan(rule) - JOINT_TAN))
        assert profile.column_slenderness is not None
        return MemberSizes(
            theta_deg=min(rule.steepest_deg, cap_deg),
            lean_deg=min(lean_deg, cap_deg),
            thickness_mm=profile.min_feature_mm,
            slenderness=profile.column_slenderness,
        )

    @property
    def tan(self) -> float:
        """tan θ: how far a funnel widens per height."""
        return math.tan(math.radians(self.theta_deg))

    @property
    def lean_tan(self) -> float:
        """The tangent of the most a column leans."""
        return math.tan(math.radians(self.lean_deg))

    @property
    def radius_mm(self) -> float:
        """Radius of a capital's lower end, and of an upright column's upper end."""
        return self.thickness_mm / 2

    @property
    def leaning_radius_mm(self) -> float:
        """Radius toward the lean of the upper end of a column that leans the most."""
        return self.radius_mm / math.cos(math.radians(self.lean_deg))

    def across_mm(self, length_mm: Float) -> Float:
        """(…,) mm, half the thickness across the axis, lengths (…,) mm below the farthest tip."""
        share = np.maximum(np.asarray(length_mm) / (self.slenderness * self.thickness_mm), 1.0)
        half: Float = self.radius_mm * share**0.75
        return half

    def cost_mm3(self, above_mm: Float | float, length_mm: Float | float) -> Float:
        """What columns cost that carry a tree: their volume, and the time they take as volume.

        above_mm : longest way up from the column to a tip;  length_mm : of the column; numbers, or
        arrays (…,) of one shape, as is the result.
        """
        above: Float = np.asarray(above_mm, dtype=np.float64)
        volume: Float = self._from_tip(above + length_mm) - self._from_tip(above)
        result: Float = volume + TIME_MM3_PER_MM * np.asarray(length_mm)
        return result

    @property
    def cost_mm2(self) -> float:
        """What an upright column of the least thickness costs per mm, in mm³."""
        return math.pi * self.radius_mm**2 + TIME_MM3_PER_MM

    def _from_tip(self, length: Float) -> Float:
        """(…,) mm³, columns of lengths (…,) mm from their tips down."""
        slender = self.slenderness * self.thickness_mm
        wide = slender * (np.maximum(length / slender, 1.0) ** 2.5 - 1) / 2.5
        result: Float = math.pi * self.radius_mm**2 * (np.minimum(length, slender) + wide)
        return result
