"""The lean program on the paper's voxels: interior and base layer, exact voxel moments.

The base layer is chosen before the program, as everywhere in printprep: the program's support
polygon must have material under it.  So B's voxels in the ground layer are a footprint, given and
full.  A few footprints are tried (none, all, and where a method is to be matched, its own), and the
lightest result counts.  B's voxels above the ground layer are free, like the interior.  The
footprint "none" leaves out B altogether.
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

# A later footprint must save at least this share of the mass.
_TIE = 1e-9


@dataclass(frozen=True, eq=False)
class Leanest:
    """The lightest density found.

    weight : (nx, ny, nz) float64 in [0, 1], at most a few voxels between the two.
    reachable_deg : largest lean of any filling; None when the lean asked for is feasible.
    """

    weight: Float
    reachable_deg: float | None


def footprints(domain: PaperDomain) -> list[NDArray[np.bool_]]:
    """The footprints to try, (nx, ny) bool each: none of B's ground layer, and all of it."""
    whole = domain.base[:, :, domain.ground]
    return [np.zeros_like(whole), whole] if whole.any() else [whole]


def leanest(domain: PaperDomain, lean_deg: float, choices: Sequence[NDArray[np.bool_]]) -> Leanest:
    """Find the lightest density that stands at a lean, over footprints (nx, ny) bool.

    Where no footprint reaches the lean, the one that reaches farthest, solved as ``solve_lean``
    does.
    """
    best: Leanest | None = None
    for footprint in choices:
        best = _better(best, _on_footprint(domain, lean_deg, footprint))
    if best is None:
        raise ValueError("No footprint is given.")
    return best


def _on_footprint(domain: PaperDomain, lean_deg: float, footprint: NDArray[np.bool_]) -> Leanest:
    """The lightest density on one footprint (nx, ny) bool."""
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
    reached, farther = _reached(first), _reached(second)
    if reached != farther:
        return second if farther > reached else first
    return second if second.weight.sum() < first.weight.sum() * (1 - _TIE) else first


def _reached(found: Leanest) -> float:
    """The lean it reaches, in degrees; +inf when that is the lean asked for."""
    return np.inf if found.reachable_deg is None else found.reachable_deg
