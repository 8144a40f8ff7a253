"""Run each method on a model's voxels; a body is a method's result."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.evaluate.methods import Method
from printprep.paper.domain import PaperDomain, build_domain
from printprep.paper.voxel_balance import tilt_deg
from printprep.paper.voxel_lean import Leanest, footprints, leanest

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float

# The program aims so much below the lean to match, so that rounding does not put it out of reach.
_HAIR_DEG = 1e-7


@dataclass(frozen=True, eq=False)
class Body:
    """The result of a method on one model.

    weight : (N, N, N) density of the material; 0 or 1 except for a few voxels on a lean's plane.
    solid : (N, N, N) bool, O;  outside : (N, N, N) bool, O with the built part of B, no cavity.
    ground : index of the layer on the bed.
    lean_deg : the lean asked for, None for a method without one.
    reachable_deg : the largest lean of any filling, where it is less than that.
    """

    weight: Float
    solid: NDArray[np.bool_]
    outside: NDArray[np.bool_]
    ground: int
    lean_deg: float | None = None
    reachable_deg: float | None = None


def body_of(
    occupied: NDArray[np.bool_], method: Method, frozen: NDArray[np.bool_] | None = None
) -> Body:
    """Run a method on an occupancy (N, N, N) bool.

    frozen : (N, N, N) bool, voxels of the shell in addition to the outermost layer of O.

    The paper's objective builds V = {ρ̃ > 0.5}, so V is weighed and judged.  The plane of a lean
    program can pass through a few voxels; they weigh the share below it.

    Raises GeometryError when no voxel is occupied.
    """
    domain = build_domain(occupied, method.settings, shell="boundary")
    if frozen is not None:
        shell = domain.shell | (frozen & domain.solid)
        interior = domain.solid & ~shell
        domain = replace(domain, shell=shell, interior=interior, free=interior | domain.base)
    if method.kind == "solid":
        return _body(domain, domain.solid.astype(np.float64))
    if method.kind == "shell":
        return _body(domain, domain.shell.astype(np.float64))
    if method.kind == "paper":
        return _body(domain, _paper(domain, method))
    if method.kind in ("lean", "lean-full-base"):
        choices = footprints(domain)
        if method.kind == "lean-full-base":
            choices = choices[-1:]
        found = leanest(domain, method.lean_deg, choices)
        return _leaned(domain, found, method.lean_deg)
    return _at_paper_tilt(domain, method)


def _at_paper_tilt(domain: PaperDomain, method: Method) -> Body:
    """The lightest body that stands at the lean at which the paper's result tips over.

    Its footprint is among those tried, so the paper's result is one of the fillings, and the body
    is never heavier.  Where the paper's result falls by itself the angle is negative: then the body
    matches how far its centre lies beyond the edge, for its height.
    """
    paper = _paper(domain, method)
    lean = tilt_deg(paper, domain.ground) - _HAIR_DEG
    its_own = (paper[:, :, domain.ground] > 0) & domain.base[:, :, domain.ground]
    found = leanest(domain, lean, [*footprints(domain), its_own])
    return _leaned(domain, found, lean)


def _paper(domain: PaperDomain, method: Method) -> Float:
    """(N, N, N) V of the paper's objective, as densities 0 and 1."""
    if method.solver == "adam":
        from printprep.paper.adam import solve_adam

        return solve_adam(domain, method.settings).material.astype(np.float64)
    from printprep.paper.plane import solve_plane

    return solve_plane(domain, method.settings).material.astype(np.float64)


def _leaned(domain: PaperDomain, found: Leanest, lean_deg: float) -> Body:
    return _body(domain, found.weight, lean_deg, found.reachable_deg)


def _body(
    domain: PaperDomain,
    weight: Float,
    lean_deg: float | None = None,
    reachable_deg: float | None = None,
) -> Body:
    """A body from densities (N, N, N)."""
    outside = domain.solid | (weight > 0)
    return Body(weight, domain.solid, outside, domain.ground, lean_deg, reachable_deg)
