"""The lightest filling that stands at a lean: a linear program whose optimum is a plane.

Notation
  n_k, d_k   outward unit normal and offset of edge k of the support polygon, pivot at z = 0
  α          the lean;  s = (M, M c_x, M c_y, M c_z)
Standing at α is (d_k − n_k·c_xy) − tan α · c_z ≥ 0 for every k, linear in s when multiplied by M.
For multipliers μ the Lagrangian fills a voxel at x exactly when Σ μ_k a_k(x) > 1, with
a_k(x) = d_k − n_k·x_xy − tan α · z: below a plane whose upward normal has n_z ≥ 0.
(Hafner et al. 2024 show the sibling for second moments; Prévost et al. 2013 carve along a plane.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.density.fillings import Filling, Fillings
from printprep.stand.footing import Footing
from printprep.types import Plane

if TYPE_CHECKING:
    from printprep.arrays import Float


# Close to the largest angle the mass explodes; at nine tenths of it the mass is small.
SHARE_OF_REACHABLE = 0.9


@dataclass(frozen=True, eq=False)
class LeanSolution:
    """The lightest filling at a lean, or at the best lean that is feasible.

    filling : densities of the voxels, moments, bound.
    plane : the cavity lies above it; None when the voxels stay empty.
    aim_deg : the lean that the filling is solved for; None when no lean above 0° is feasible.
    reachable_deg : largest lean of any filling; None when the lean asked for is feasible.
    """

    filling: Filling
    plane: Plane | None
    aim_deg: float | None
    reachable_deg: float | None


def solve_lean(
    voxels: Fillings, fixed: Float, footing: Footing, lean_deg: float, margin_deg: float = 0.0
) -> LeanSolution:
    """Find the filling of least mass that stands at a lean, with a margin where that is feasible.

    Parameters
    ----------
    voxels : moments of the free voxels about the origin, z from the bed.
    fixed : (4,) moments of everything else, in mm³ and mm⁴.
    lean_deg, margin_deg : the program is solved at their sum; where only the lean itself is
        feasible, half way between it and the largest feasible angle; where the lean is not
        feasible, at nine tenths of that angle.  Where no filling stands upright, nothing is filled.
    """
    filling = voxels.lightest(fixed, footing.constraints(lean_deg + margin_deg))
    if filling is not None:
        aim = lean_deg + margin_deg
        return LeanSolution(filling, separating_plane(filling, footing, aim), aim, None)
    reachable = largest_lean(voxels, fixed, footing)
    feasible = reachable > lean_deg
    aim = (lean_deg + reachable) / 2 if feasible else SHARE_OF_REACHABLE * reachable
    if aim <= 0:
        empty = np.zeros(voxels.moments.shape[1])
        filling = Filling(empty, fixed, np.zeros(len(footing.offsets_mm)), float(fixed[0]))
        return LeanSolution(filling, None, None, reachable)
    filling = voxels.lightest(fixed, footing.constraints(aim))
    if filling is None:
        raise ArithmeticError(
            f"No filling stands at {aim}°, below the largest feasible {reachable}°."
        )
    plane = separating_plane(filling, footing, aim)
    return LeanSolution(filling, plane, aim, None if feasible else reachable)


def largest_lean(voxels: Fillings, fixed: Float, footing: Footing) -> float:
    """Find the largest tilt angle of any filling, in degrees; negative when none stands upright.

    fixed : (4,) moments of everything but the voxels.
    Dinkelbach's method (1967) on the ratio of edge distance to height: each round takes the filling
    that is farthest ahead of the ratio so far, and goes on with that filling's own ratio.
    """
    ratio = footing.tangent(fixed)
    while True:
        worst, moments = voxels.feasible(fixed, footing.constraints(np.degrees(np.arctan(ratio))))
        better = footing.tangent(moments)
        if worst <= 0 or better <= ratio + 1e-9:
            return float(np.degrees(np.arctan(ratio)))
        ratio = better


def separating_plane(filling: Filling, footing: Footing, lean_deg: float) -> Plane | None:
    """The plane of an optimal filling: empty where normal · x > offset; None without a plane."""
    if not filling.multipliers.any():
        return None
    affine = filling.multipliers @ footing.constraints(lean_deg)
    # Full where affine[0] + affine[1:]·x > 1, so empty where −affine[1:]·x > affine[0] − 1.
    normal, offset = -affine[1:], affine[0] - 1.0
    length = float(np.linalg.norm(normal))
    nx, ny, nz = (float(v) for v in normal / length)
    return Plane((nx, ny, nz), float(offset / length))
