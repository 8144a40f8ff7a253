"""Parameters of the paper's optimization, with the paper's values as defaults.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code
(github.com/idvxlab/DensiCrafter).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

from printprep.errors import UsageError

Reach = Literal["below", "within"]


@dataclass(frozen=True)
class PaperSettings:
    """N, λ, ε, Adam's seed, steps and rate, and a switch for each of the paper's ablations.

    resolution : N, voxels along the grid's edge; L_mass is a mean over N³.
    mass_weight : λ.
    epsilon : ε, voxels: height of the base layer B, and the bound on its L1 distance to O.
    base_reach : "below" keeps B at L1 distances below ε, as the paper says; "within" includes ε
        itself, as the authors' code does, which makes B twice as wide at ε = 2.
    seed, steps, rate : of Adam; the paper's text gives a rate of 1e-2, the authors' code 0.05.
    center, region, height, mass : False drops L_center, L_region, L_z, L_mass.
    smoothing : False takes ρ̃ = ρ;  base : False leaves B empty.

    Raises UsageError for an invalid value.
    """

    resolution: int = 64
    mass_weight: float = 100.0
    epsilon: int = 2
    base_reach: Reach = "below"
    seed: int = 42
    steps: int = 2000
    rate: float = 0.05
    center: bool = True
    region: bool = True
    height: bool = True
    mass: bool = True
    smoothing: bool = True
    base: bool = True

    def __post_init__(self) -> None:
        for name, low in (("resolution", 1), ("epsilon", 0), ("steps", 1), ("seed", 0)):
            value = getattr(self, name)
            if value < low:
                raise UsageError(
                    f"{name}={value} is too small.", f"Use a whole number of at least {low}."
                )
        if not (math.isfinite(self.mass_weight) and self.mass_weight >= 0):
            raise UsageError(
                f"mass_weight={self.mass_weight} is invalid.", "Use a number of at least 0."
            )
        if not (math.isfinite(self.rate) and self.rate > 0):
            raise UsageError(f"rate={self.rate} is invalid.", "Use a number above 0.")
        if self.base_reach not in get_args(Reach):
            raise UsageError(f"base_reach={self.base_reach!r} is invalid.", "Use below or within.")

    @property
    def mass_slope(self) -> float:
        """∂(λ L_mass)/∂M, per voxel of material."""
        return self.mass_weight / self.resolution**3 if self.mass else 0.0
