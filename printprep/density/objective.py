"""The paper's objective: value and gradient in closed form, in the space of s and g.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code
(github.com/idvxlab/DensiCrafter).  The code is followed where the two differ:

- L_mass is the mean of ρ̃ over the N³ voxels of the grid (paper: the integral ∫ρ̃ dV);
- all lengths are voxels, and L_z is measured from the ground layer;
- the contact is soft, g(x, y) = max over k ≥ 0 of 4^(−k) ρ̃(x, y, ground + k), and L_center and
  L_region are weighted by it (paper: an indicator ρ̃ > 0.5 at the lowest layer);
- the learning rate is 0.05 (paper: 1e-2) and the logits start at ±10 with N(0, 1) noise.

Notation: M mass, c centre of mass, s = (M, M c_x, M c_y, M c_z), g soft contact per column,
p column position, G = Σ g.  Then

    L_center = Σ g ‖c_xy − p‖ / G,   L_region = −G,   L_z = c_z − ground,   L_mass = M / N³,
    L = L_center + L_region + L_z + λ L_mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from printprep.errors import UsageError

Float = NDArray[np.float64]


@dataclass(frozen=True)
class PaperSettings:
    """Parameters of the paper's optimization, with its values, and a switch for each ablation.

    resolution : N, voxels along the grid's edge; L_mass is a mean over N³.
    mass_weight : λ.
    epsilon : ε, height and reach of the base layer in voxels.
    seed, steps, rate : of Adam; the paper's text has a rate of 1e-2, the authors' code 0.05.
    center, region, height, mass : False drops L_center, L_region, L_z, L_mass.
    smoothing : False takes ρ̃ = ρ;  base : False leaves B empty.
    """

    resolution: int = 64
    mass_weight: float = 100.0
    epsilon: int = 2
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
        for name, low in (("resolution", 1), ("epsilon", 0), ("steps", 1)):
            value = getattr(self, name)
            if value < low:
                raise UsageError(f"{name} is {value}", f"give a whole number of at least {low}")
        if not (np.isfinite(self.mass_weight) and self.mass_weight >= 0):
            raise UsageError(f"mass_weight is {self.mass_weight}", "give a number of at least 0")
        if not (np.isfinite(self.rate) and self.rate > 0):
            raise UsageError(f"rate is {self.rate}", "give a number above 0")

    @property
    def mass_slope(self) -> float:
        """∂(λ L_mass)/∂M."""
        return self.mass_weight / self.resolution**3 if self.mass else 0.0


@dataclass(frozen=True)
class Terms:
    """The loss and its parts, each in the units of the paper's code; dropped terms are 0.

    mass is λ L_mass, the others carry weight 1.
    """

    center: float
    region: float
    height: float
    mass: float

    @property
    def total(self) -> float:
        """L."""
        return self.center + self.region + self.height + self.mass


def terms(s: Float, g: Float, columns: Float, settings: PaperSettings) -> Terms:
    """The loss terms.

    s : (4,) M, M c_x, M c_y, M c_z, with c_z measured from the ground layer;
    g : (C,) soft contact;  columns : (C, 2) x, y of each column in the same frame as s.
    """
    c = s[1:] / s[0]
    center = 0.0
    if settings.center:
        center = float(g @ np.hypot(*(c[:2] - columns).T) / g.sum())
    return Terms(
        center=center,
        region=-float(g.sum()) if settings.region else 0.0,
        height=float(c[2]) if settings.height else 0.0,
        mass=settings.mass_slope * float(s[0]),
    )


def gradient(s: Float, g: Float, columns: Float, settings: PaperSettings) -> tuple[Float, Float]:
    """∂L/∂s, (4,), and ∂L/∂g, (C,); arguments as for `terms`.

    ‖·‖ has subgradient 0 at 0.
    """
    mass = s[0]
    c = s[1:] / mass
    by_c = np.zeros(3)
    by_g = np.zeros_like(g)
    if settings.center:
        offset = c[:2] - columns
        distance = np.hypot(offset[:, 0], offset[:, 1])
        weight = np.divide(g, distance, out=np.zeros_like(g), where=distance > 0)
        by_c[:2] = weight @ offset / g.sum()
        by_g += (distance - g @ distance / g.sum()) / g.sum()
    if settings.region:
        by_g -= 1.0
    if settings.height:
        by_c[2] = 1.0
    by_s = np.concatenate(([settings.mass_slope - by_c @ c / mass], by_c / mass))
    return by_s, by_g
