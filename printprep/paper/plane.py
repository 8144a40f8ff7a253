"""Solve the paper's objective exactly: the cavity is the interior above a plane.

The loss depends on ρ only through s = (M, M c) and the soft contact, so at a stationary point each
free voxel is 0 or 1 by the sign of its gradient q · W_i, an affine function of position where the
kernel's neighbourhood is free.  (Hafner et al., "Spin-It Faster", 2024, prove the sibling for
second moments, where the interface is a quadric; Prévost et al., "Make It Stand", SIGGRAPH 2013,
carve along a plane.)

Each step goes toward the vertex ρ' = [gradient < 0] by an exact line search on the segment (the
conditional-gradient method of Frank & Wolfe, 1956), on which s is four scalars that move linearly.
The contact is a maximum, so the loss can have more than one stationary point: the solver starts
from the bare shell, as the authors do, and from everything filled, and keeps the better result.  On
a symmetric model a whole layer can tie on the plane, with the optimum between full and empty; such
a layer stays fractional, and `PaperSolution.fractional` counts it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from printprep.arrays import Float
from printprep.paper.domain import PaperDomain
from printprep.paper.linear_form import LinearForm, linear_form
from printprep.paper.objective import Terms, terms
from printprep.paper.settings import PaperSettings
from printprep.types import Grid, Plane

MAX_STEPS = 60
GAP = 1e-9  # stop when the linear model promises less than this share of the loss
STALL = 1e-8, 3  # stop after this many steps in a row that each gain less than this share
ROUNDING = 1e-8  # share of the loss that rounding all voxels to 0 or 1 may cost
SAMPLES = 17  # of the segment, before the best bracket is refined
SHARE = 1e-10  # precision of the least loss on a segment, as a share of it
END = 1e-4  # go to a segment's end when that is better than this share before it


@dataclass(frozen=True)
class VoxelPlane:
    """The half-space {v : normal · v > offset} of voxel indices v; it stays empty.

    normal : unit length;  offset : voxels.
    """

    normal: tuple[float, float, float]
    offset: float

    def in_mm(self, grid: Grid) -> Plane:
        """The same plane in the coordinates of ``grid``; it cuts at any resolution."""
        start = float(np.dot(self.normal, grid.origin_mm))
        return Plane(self.normal, start + grid.pitch_mm * self.offset)


@dataclass(frozen=True, eq=False)
class PaperSolution:
    """A density for the paper's objective.

    rho : (nx, ny, nz) float64 in [0, 1], before smoothing;  smoothed : ρ̃, same shape.
    material : V = {ρ̃ > 0.5}, bool;  cavity : H = {v ∈ O : ρ̃ ≤ 0.5}, bool.
    plane : above it the voxels are empty; None when the objective prefers no half-space, when no
        voxel is free, or when the solver finds no plane.
    terms : the loss at the result;  trace : (k,) float64, the loss at each step.
    fractional : free voxels with ρ strictly between 0 and 1.
    """

    rho: Float
    smoothed: Float
    material: NDArray[np.bool_]
    cavity: NDArray[np.bool_]
    plane: VoxelPlane | None
    terms: Terms
    trace: Float
    fractional: int


def solve_plane(domain: PaperDomain, settings: PaperSettings) -> PaperSolution:
    """Find the density that minimizes the paper's objective on a domain; deterministic.

    A domain without free voxels gives the shell, and no plane.
    """
    form = linear_form(domain, settings)
    starts = [np.zeros(form.count)]
    if len(form.slots):
        starts.append(np.ones(form.count))
    ends = [_descend(form, start) for start in starts]
    rho, trace = min(ends, key=lambda end: float(end[1][-1]))
    plane = _plane(form, rho)
    rounded = (rho > 0.5).astype(np.float64)
    loss = form.terms(rounded).total
    if loss <= trace[-1] + ROUNDING * max(1.0, abs(trace[-1])):
        rho, trace = rounded, np.append(trace, loss)
    return package(form, rho, trace, plane)


def package(form: LinearForm, rho: Float, trace: Float, plane: VoxelPlane | None) -> PaperSolution:
    """A solution on the grid.

    rho : (n,) free densities;  trace : (k,) the loss at each step.
    """
    whole = form.frozen.copy()
    whole[tuple(form.voxels.T)] = rho
    smoothed = form.field(rho)
    material = smoothed > 0.5
    return PaperSolution(
        rho=whole,
        smoothed=smoothed,
        material=material,
        cavity=form.domain.solid & ~material,
        plane=plane,
        terms=form.terms(rho),
        trace=trace,
        fractional=int(np.count_nonzero((rho > 0) & (rho < 1))),
    )


def _descend(form: LinearForm, start: Float) -> tuple[Float, Float]:
    """Free densities (n,) at a stationary point, and the loss (k,) at every step to it.

    start : (n,) free densities.
    """
    rho = start
    trace = [form.terms(rho).total]
    small, patience = STALL
    stalled = 0
    while len(trace) <= MAX_STEPS and stalled < patience:
        scale = max(1.0, abs(trace[-1]))
        slope, _ = form.gradient(rho)
        vertex = (slope < 0).astype(np.float64)
        if float(np.sum(slope * (rho - vertex))) <= GAP * scale:
            break
        loss, share = _line_search(form, rho, vertex)
        if loss >= trace[-1]:
            break
        stalled = stalled + 1 if trace[-1] - loss < small * scale else 0
        rho = vertex if share == 1.0 else rho + share * (vertex - rho)
        trace.append(loss)
    return rho, np.array(trace)


def _line_search(form: LinearForm, rho: Float, vertex: Float) -> tuple[float, float]:
    """The least loss on the segment from ``rho`` (n,) to ``vertex`` (n,), and its share of the way.

    On the segment s is linear, and each column's contact is the largest of a few linear functions.
    """
    s0, s1 = form.moments(rho), form.moments(vertex)
    e0, e1 = form.contact(rho), form.contact(vertex)

    def loss(share: float) -> float:
        s = s0 + share * (s1 - s0)
        g = form.ground(e0 + share * (e1 - e0))
        return terms(s, g, form.columns, form.settings).total

    return _minimize(loss)


def _minimize(loss: Callable[[float], float]) -> tuple[float, float]:
    """Least value of a function on [0, 1], and its place: by samples, then by Brent's method."""
    from scipy.optimize import minimize_scalar

    grid = np.linspace(0.0, 1.0, SAMPLES)
    values = [loss(float(share)) for share in grid]
    best = int(np.argmin(values))
    least, at = values[best], float(grid[best])
    if at == 1.0 and least <= loss(1.0 - END):
        return least, at
    bracket = (float(grid[max(best - 1, 0)]), float(grid[min(best + 1, SAMPLES - 1)]))
    found = minimize_scalar(loss, bounds=bracket, method="bounded", options={"xatol": SHARE})
    return min((least, at), (float(found.fun), float(found.x)))


def _plane(form: LinearForm, rho: Float) -> VoxelPlane | None:
    """The plane q · (1, v) = 0 at a stationary point (n,), in voxel indices."""
    if not form.count:
        return None
    _, q = form.gradient(rho)
    length = float(np.linalg.norm(q[1:]))
    if length == 0.0:
        return None
    normal = q[1:] / length
    offset = float(normal @ form.reference - q[0] / length)
    return VoxelPlane((float(normal[0]), float(normal[1]), float(normal[2])), offset)
