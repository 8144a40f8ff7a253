"""The paper's objective: value and gradient in closed form, as functions of s and g.

Source: Dang et al., "DensiCrafter", AAAI 2026, arXiv 2511.09298, and the authors' published code
(github.com/idvxlab/DensiCrafter).  Where the two differ this follows the code:

- L_mass is the mean of ρ̃ over the N³ voxels of the grid (paper: the integral ∫ρ̃ dV);
- all lengths are voxels, and L_z is measured from the ground layer;
- the contact is soft, g(x, y) = max over k ≥ 0 of 4^(−k) ρ̃(x, y, ground + k), and L_center and
  L_region are weighted by it (paper: an indicator ρ̃ > 0.5 at the lowest layer).

Notation: M mass, c centre of mass, s = (M, M c_x, M c_y, M c_z), g soft contact per column,
p column position, G = Σ g.  Then

    L_center = Σ g ‖c_xy − p‖ / G,   L_region = −G,   L_z = c_z − ground,   L_mass = M / N³,
    L = L_center + L_region + L_z + λ L_mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from printprep.arrays import Float
from printprep.paper.settings import PaperSettings as PaperSettings

TINY = 1e-300  # in place of a distance of 0, whose offset is 0 too


@dataclass(frozen=True)
class Terms:
    """The parts of the loss, in the units of the paper's code; dropped terms are 0.

    mass is λ L_mass, the others have weight 1.
    """

    center: float
    region: float
    height: float
    mass: float

    @property
    def total(self) -> float:
        """L, the loss."""
        return self.center + self.region + self.height + self.mass


def terms(s: Float, g: Float, columns: Float, settings: PaperSettings) -> Terms:
    """The loss terms.

    s : (4,) M, M c_x, M c_y, M c_z, with c_z measured from the ground layer;
    g : (C,) soft contact;  columns : (C, 2) x, y of each column in the same frame as s.
    """
    return gradient(s, g, columns, settings)[0]


def gradient(
    s: Float, g: Float, columns: Float, settings: PaperSettings
) -> tuple[Terms, Float, Float]:
    """The loss terms, ∂L/∂s (4,) and ∂L/∂g (C,); arguments as for `terms`.

    ‖·‖ has subgradient 0 at 0.
    """
    mass = s[0]
    c = s[1:] / mass
    total = g.sum()
    by_c = np.zeros(3)
    by_g = np.full(len(g), -1.0 if settings.region else 0.0)
    center = 0.0
    if settings.center:
        offset = c[:2] - columns
        distance = np.sqrt(np.einsum("ij,ij->i", offset, offset))
        center = float(g @ distance / total)
        by_c[:2] = (g / np.maximum(distance, TINY)) @ offset / total
        by_g += (distance - center) / total
    if settings.height:
        by_c[2] = 1.0
    by_s = np.concatenate(([settings.mass_slope - by_c @ c / mass], by_c / mass))
    value = Terms(
        center=center,
        region=-float(total) if settings.region else 0.0,
        height=float(c[2]) if settings.height else 0.0,
        mass=settings.mass_slope * float(mass),
    )
    return value, by_s, by_g
