"""The mass of the part with another fill, estimated with the same base and without a slicer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.pipeline.fills import FILLS
from printprep.types import AlternativeFill

if TYPE_CHECKING:
    from printprep.pipeline.filled import Filled
    from printprep.pipeline.prepare import Prepared
    from printprep.types import Lean


def alternative_fill(
    chosen: str, prepared: Prepared, filled: Filled, lean: Lean
) -> AlternativeFill | None:
    """The lightest fill other than ``chosen``; None where the profile has no infill.

    Vaults inside a cavity are not counted.
    """
    profile = filled.profile
    if profile.infill is None:
        return None
    base, grams_per_mm3 = filled.part.base, profile.material.density_g_cm3 / 1000
    others, depths = [], filled.depths.for_estimates()
    for name, fill in FILLS.items():
        if name == chosen:
            continue
        volume_mm3 = fill.estimate_mm3(prepared.solid, depths, profile, base, lean)
        if volume_mm3 is not None:
            others.append(AlternativeFill(name, volume_mm3 * grams_per_mm3))
    return min(others, key=lambda other: other.mass_g, default=None)
