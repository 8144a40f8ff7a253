"""The lightest filling that stands when leaned: a linear program with a plane for its optimum.

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


# Close to the largest angle the mass explodes; nine tenths of it cost little (method.md).
SHARE_OF_REACHABLE = 0.9


@dataclass(frozen=True, eq=False)
class LeanSolution:
    """The lightest filling, or the best there is.

    filling : densities of the voxels, moments, bound.
    plane : the cavity lies above it; None when the voxels stay empty.
    aim_deg : the lean that the filling was solved for; None when none above 0° can be reached.
    reachable_deg : largest lean of any filling; None when the lean asked for was feasible.
    """

    filling: Filling
    plane: Plane | None
    aim_deg: float | None
    reachable_deg: float | None


def solve_lean(
    voxels: Fillings, fixed: Float, footing: Footing, lean_deg: float, margin_deg: float = 0.0
) -> LeanSolution:
    """Least mass that stands at a lean, with a margin where the margin can be had.

    Parameters
    ----------
    voxels : the free voxels' moments about the origin, z from the bed.
    fixed : (4,) moments of everything else.
    lean_deg, margin_deg : solved at their sum; where only the lean itself is feasible, half way
    between it and the largest feasible angle; where it is not, at nine tenths of that angle; and
    where no filling stands upright, nothing is filled.
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
        raise ArithmeticError(f"no filling at {aim}°, below the largest feasible {reachable}°")
    plane = separating_plane(filling, footing, aim)
    return LeanSolution(filling, plane, aim, None if feasible else reachable)


def largest_lean(voxels: Fillings, fixed: Float, footing: Footing) -> float:
    """The largest tilt angle of any filling, degrees; negative when none stands upright.

    Dinkelbach's method (1967) on the ratio of edge distance to height: each round takes the
    filling that is most ahead of the ratio so far, and its own ratio next.
    """
    ratio = footing.tangent(fixed)
    while True:
        worst, moments = voxels.feasible(fixed, footing.constraints(np.degrees(np.arctan(ratio))))
        better = footing.tangent(moments)
        if worst <= 0 or better <= ratio + 1e-9:
            return float(np.degrees(np.arctan(ratio)))
        ratio = better


def separating_plane(filling: Filling, footing: Footing, lean_deg: float) -> Plane | None:
    """The plane of an optimal filling: empty where normal · x > offset."""
    if not filling.multipliers.any():
        return None
    affine = filling.multipliers @ footing.constraints(lean_deg)
    # Full where affine[0] + affine[1:]·x > 1, so empty where −affine[1:]·x > affine[0] − 1.
    normal, offset = -affine[1:], affine[0] - 1.0
    length = float(np.linalg.norm(normal))
    nx, ny, nz = (float(v) for v in normal / length)
    return Plane((nx, ny, nz), float(offset / length))
