"""The lean program in the paper's voxel picture: interior and base layer, exact voxel moments.

Whether the base layer is there is decided before the program, as everywhere in this house: the
support polygon the program works with must have material under it.  So B's voxels in the ground
layer are a footprint, given and full, of which a few are tried (none, all, and where there is one
to match, another method's), and the lightest result counts.  B's voxels above the ground layer are
free, like the interior.  The footprint "none" leaves B out altogether.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.density.fillings import Fillings
from printprep.density.lean import LeanSolution, solve_lean
from printprep.paper.domain import PaperDomain
from printprep.paper.voxel_balance import footing, moment_columns

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float

# A footprint is larger for a reason: by at least this share of the mass.
_TIE = 1e-9


@dataclass(frozen=True, eq=False)
class Leanest:
    """The lightest density found.

    weight : (nx, ny, nz) float64 in [0, 1], a few voxels at most between the two.
    reachable_deg : the largest lean of any filling where the lean asked for is out of reach.
    """

    weight: Float
    reachable_deg: float | None


def footprints(domain: PaperDomain) -> list[NDArray[np.bool_]]:
    """None of B's ground layer, and all of it; (nx, ny) bool each."""
    whole = domain.base[:, :, domain.ground]
    return [np.zeros_like(whole), whole] if whole.any() else [whole]


def leanest(domain: PaperDomain, lean_deg: float, choices: Sequence[NDArray[np.bool_]]) -> Leanest:
    """The lightest density that stands at a lean, over all footprints (nx, ny) bool.

    Where no footprint reaches the lean, the one that reaches farthest, solved as ``solve_lean``
    does.
    """
    best: Leanest | None = None
    for footprint in choices:
        best = _better(best, _on_footprint(domain, lean_deg, footprint))
    if best is None:
        raise ValueError("there is no footprint to choose from")
    return best


def _on_footprint(domain: PaperDomain, lean_deg: float, footprint: NDArray[np.bool_]) -> Leanest:
    fixed = domain.shell.copy()
    fixed[:, :, domain.ground] |= footprint
    free = domain.interior.copy()
    if footprint.any():
        free |= domain.base
        free[:, :, domain.ground] &= domain.interior[:, :, domain.ground]
    voxels = np.argwhere(free)
    weight = fixed.astype(np.float64)
    given = moment_columns(np.argwhere(fixed), domain.shape, domain.ground).sum(axis=1)
    program = Fillings(moment_columns(voxels, domain.shape, domain.ground))
    solution: LeanSolution = solve_lean(
        program, given, footing(fixed[:, :, domain.ground]), lean_deg
    )
    weight[tuple(voxels.T)] = solution.filling.rho
    return Leanest(weight, solution.reachable_deg)


def _better(first: Leanest | None, second: Leanest) -> Leanest:
    """The lighter of two that reach the lean, else the one that reaches farther."""
    if first is None:
        return second
    reached = [
        np.inf if one.reachable_deg is None else one.reachable_deg for one in (first, second)
    ]
    if reached[0] != reached[1]:
        return second if reached[1] > reached[0] else first
    return second if second.weight.sum() < first.weight.sum() * (1 - _TIE) else first


def _reached(found: Leanest) -> float:
    return np.inf if found.reachable_deg is None else found.reachable_deg
