"""The lightest filling of free voxels: linear programs over the moments that fillings can have.

Notation
  s     (M, M c_x, M c_y, M c_z): mass and first moments of all material
  s₀    the same for the material that is there whatever the filling
  W     (4, n): the moments one voxel adds when it is full;  ρ ∈ [0, 1]ⁿ the filling
  Z     {s₀ + Wρ}: a zonotope in four dimensions, however many voxels there are
  H s ≥ 0, c·s   constraints and cost, linear in s

Every linear functional of s is extremal over Z at a filling that is 0 or 1 by the sign of one
affine function of position.  So such half-space fillings explore Z (Dantzig & Wolfe 1960), each a
mat-vec over the voxels, and the program over the few found so far stays tiny.  The voxels near the
last half-space then go, with all constraints, to HiGHS, whose multipliers give a lower bound over
*all* voxels: the certificate.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.density.column_program import INFINITE, ColumnProgram

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float


# Rounds of pricing at most; the moments of some tens of half-spaces describe a four-dimensional
# body to far below a voxel.
MOST_ROUNDS = 400


@dataclass(frozen=True, eq=False)
class Filling:
    """An optimal filling.

    rho : (n,) density of each voxel, in [0, 1];  moments : (4,) its s, s₀ included, in mm³ and mm⁴.
    multipliers : (k,) ≥ 0, one per constraint;  bound : mm³, no filling weighs less (weak duality).
    """

    rho: Float
    moments: Float
    multipliers: Float
    bound: float


class Fillings:
    """Half-space fillings of one set of voxels, kept from one program to the next.

    moments : (4, n), W in the notation above, in mm³ and mm⁴; row 0 positive.
    """

    def __init__(self, moments: Float) -> None:
        """moments : (4, n) W."""
        self.moments = np.ascontiguousarray(moments)
        self._columns = np.stack([np.zeros(4), self.moments.sum(axis=1)])

    def cheapest(self, cost: Float) -> tuple[Float, NDArray[np.bool_]]:
        """The filling that minimises cost · W ρ: its moments (4,), and its full voxels (n,) bool.

        cost : (4,).
        """
        chosen = cost @ self.moments < 0
        return self.moments @ chosen, chosen

    def feasible(self, fixed: Float, constraints: Float) -> tuple[float, Float]:
        """Find the largest t with H s ≥ t over all fillings, to 1e-9 of the constraints' scale.

        The search stops at the first positive t: then the program is feasible.

        Parameters
        ----------
        fixed : (4,) s₀;  constraints : (k, 4) H.

        Returns
        -------
        t, and the moments (4,) of a filling that reaches it (a mean of half-space fillings).
        """
        scale = np.abs(constraints @ (fixed + self._columns[1])).max() + 1e-300
        program = _MaxMin(constraints @ (self._columns + fixed).T)
        while True:
            worst, weights, multipliers = program.solve()
            if worst > 1e-9 * scale:
                break
            column, _ = self.cheapest(-(multipliers @ constraints))
            best = float(multipliers @ constraints @ (column + fixed))
            if best - worst <= 1e-9 * scale or not self._add(column):
                break
            program.add(constraints @ (column + fixed))
        return worst, weights @ self._columns + fixed

    def lightest(self, fixed: Float, constraints: Float, gap: float = 1e-7) -> Filling | None:
        """Find the filling of least mass with H s ≥ 0, with proof; None when no filling has it.

        Parameters
        ----------
        fixed : (4,) s₀;  constraints : (k, 4) H;  gap : relative gap of mass to prove.
        """
        if len(self.moments.T) == 0 or np.all(constraints @ fixed >= 0):
            return self._nothing_added(fixed, constraints)
        worst, _ = self.feasible(fixed, constraints)
        if worst < 0:
            return None
        multipliers = self._price(fixed, constraints)
        return self._finish(fixed, constraints, multipliers, gap)

    def _nothing_added(self, fixed: Float, constraints: Float) -> Filling | None:
        """The empty filling, or None where s₀ (4,) does not satisfy H (k, 4)."""
        if np.any(constraints @ fixed < 0):
            return None
        empty = np.zeros(self.moments.shape[1])
        return Filling(empty, fixed, np.zeros(len(constraints)), float(fixed[0]))

    def _price(self, fixed: Float, constraints: Float) -> Float:
        """(k,) multipliers near the optimal ones, by column generation."""
        mass = np.array([1.0, 0.0, 0.0, 0.0])
        columns = (self._columns + fixed).T
        program = _LeastCost(columns[0], constraints @ columns)
        for _ in range(MOST_ROUNDS):
            value, multipliers = program.solve()
            cost = mass - multipliers @ constraints
            column, _ = self.cheapest(cost)
            bound = float(cost @ (column + fixed))
            if value - bound <= 1e-6 * value or not self._add(column):
                break
            program.add(float(column[0] + fixed[0]), constraints @ (column + fixed))
        return multipliers

    def _finish(self, fixed: Float, constraints: Float, multipliers: Float, gap: float) -> Filling:
        """Solve exactly over the voxels near the half-space, widening until the gap is proven.

        fixed : (4,) s₀;  constraints : (k, 4) H;  multipliers : (k,), near the optimal ones.
        """
        mass = np.array([1.0, 0.0, 0.0, 0.0])
        count = self.moments.shape[1]
        near = 500
        while True:
            price = (mass - multipliers @ constraints) @ self.moments / self.moments[0]
            near = min(near, count)
            band = np.argpartition(np.abs(price), near - 1)[:near]
            band.sort()
            rho = (price < 0).astype(float)
            rho[band] = 0
            outside = fixed + self.moments @ rho
            solved = _band_program(outside, constraints, self.moments[:, band])
            if solved is not None:
                rho[band], multipliers = solved
                cost = mass - multipliers @ constraints
                bound = float(cost @ fixed + np.minimum(cost @ self.moments, 0).sum())
                moments = fixed + self.moments @ rho
                if moments[0] - bound <= gap * moments[0] or near == count:
                    return Filling(rho, moments, multipliers, bound)
            elif near == count:
                raise ArithmeticError("The solver finds a feasible program infeasible.")
            near *= 4

    def _add(self, column: Float) -> bool:
        """Keep the moments (4,) of a half-space filling; False when they are known already."""
        size = np.abs(self._columns[1]) + 1e-300
        if (np.abs(self._columns - column) <= 1e-13 * size).all(axis=1).any():
            return False
        self._columns = np.vstack([self._columns, column])
        return True


class _MaxMin:
    """The largest t with values (k, c) @ w ≥ t, where w ≥ 0 and Σw = 1."""

    def __init__(self, values: Float) -> None:
        """values : (k, c)."""
        rows, count = values.shape
        self._scale = np.abs(values).max() + 1e-300
        self._program = ColumnProgram(
            np.append(-1.0, np.zeros(count)),
            np.block([[-np.ones((rows, 1)), values / self._scale], [0.0, np.ones(count)]]),
            rows=(np.append(np.zeros(rows), 1.0), np.append(np.full(rows, INFINITE), 1.0)),
            bounds=(np.append(-INFINITE, np.zeros(count)), np.full(count + 1, INFINITE)),
        )

    def add(self, values: Float) -> None:
        """Add a column (k,)."""
        self._program.add(0.0, np.append(values / self._scale, 1.0))

    def solve(self) -> tuple[float, Float, Float]:
        """t, w (c,), and multipliers (k,) of sum 1."""
        found = self._program.solve()
        if found is None:
            raise ArithmeticError("The solver finds no weights, though any one of them is some.")
        multipliers = np.maximum(found.multipliers[:-1], 0)
        weights = np.maximum(found.x[1:], 0)
        return (
            float(found.x[0] * self._scale),
            weights / weights.sum(),
            multipliers / multipliers.sum(),
        )


class _LeastCost:
    """The least costs (c,) @ w with values (k, c) @ w ≥ 0, where w ≥ 0 and Σw = 1."""

    def __init__(self, costs: Float, values: Float) -> None:
        """costs : (c,), some above 0;  values : (k, c)."""
        rows, count = values.shape
        self._scale = np.abs(values).max() + 1e-300
        self._unit, self._rows = costs.max(), rows
        self._program = ColumnProgram(
            costs / self._unit,
            np.vstack([values / self._scale, np.ones(count)]),
            rows=(np.append(np.zeros(rows), 1.0), np.append(np.full(rows, INFINITE), 1.0)),
            bounds=(np.zeros(count), np.full(count, INFINITE)),
        )

    def add(self, cost: float, values: Float) -> None:
        """Add a column (k,) and its cost."""
        self._program.add(cost / self._unit, np.append(values / self._scale, 1.0))

    def solve(self) -> tuple[float, Float]:
        """The least cost, +inf where there is none, and the multipliers (k,)."""
        found = self._program.solve()
        if found is None:
            return INFINITE, np.zeros(self._rows)
        multipliers = np.maximum(found.multipliers[:-1], 0) * self._unit / self._scale
        return found.cost * self._unit, multipliers


def _band_program(outside: Float, constraints: Float, moments: Float) -> tuple[Float, Float] | None:
    """Least mass over a few voxels: their densities (n,) and the rows' multipliers (k,), or None.

    outside : (4,) moments of all else;  constraints : (k, 4) H;  moments : (4, n) of the voxels.
    """
    rows = constraints @ moments
    count = rows.shape[1]
    scale = np.abs(rows).max() + 1e-300
    unit = moments[0].max()
    found = ColumnProgram(
        moments[0] / unit,
        rows / scale,
        rows=(-(constraints @ outside) / scale, np.full(len(rows), INFINITE)),
        bounds=(np.zeros(count), np.ones(count)),
    ).solve()
    if found is None:
        return None
    return np.clip(found.x, 0, 1), np.maximum(found.multipliers, 0) * unit / scale
