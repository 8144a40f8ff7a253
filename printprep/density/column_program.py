"""Linear programs whose columns arrive one by one, solved by HiGHS's simplex method.

    minimise cost · x   where   lower ≤ A x ≤ upper,   x between its bounds

Between two columns the solver keeps its basis, so that each solution starts from the last.

Huangfu and Hall, "Parallelizing the dual revised simplex method", 2018 (HiGHS).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float

INFINITE = np.inf


@dataclass(frozen=True, eq=False)
class Optimum:
    """A solution: its least cost, x (n,), and the multiplier of each row (k,).

    A multiplier is positive where a row holds the cost up at its lower bound.
    """

    cost: float
    x: Float
    multipliers: Float


class ColumnProgram:
    """One linear program that columns can be added to."""

    def __init__(
        self, costs: Float, matrix: Float, rows: tuple[Float, Float], bounds: tuple[Float, Float]
    ) -> None:
        """costs : (n,);  matrix : (k, n) A;  rows : (k,) lower and upper;  bounds : (n,) of x."""
        import highspy

        count, size = matrix.shape
        self._solver = highspy.Highs()
        for name, value in _OPTIONS.items():
            self._solver.setOptionValue(name, value)
        self._solver.passModel(
            size,
            count,
            matrix.size,
            int(highspy.MatrixFormat.kColwise),
            int(highspy.ObjSense.kMinimize),
            0.0,
            *(np.ascontiguousarray(of_column) for of_column in (costs, *bounds)),
            *(np.ascontiguousarray(of_row) for of_row in rows),
            np.arange(size, dtype=np.int32) * count,
            np.tile(np.arange(count, dtype=np.int32), size),
            matrix.T.ravel(),
            np.zeros(size, dtype=np.int32),
        )
        self._optimal = highspy.HighsModelStatus.kOptimal
        self._rows = np.arange(count, dtype=np.int32)

    def add(self, cost: float, column: Float) -> None:
        """Add a variable that is not negative: its cost, and its column (k,) of A."""
        self._solver.addCol(cost, 0.0, INFINITE, len(self._rows), self._rows, column)

    def solve(self) -> Optimum | None:
        """Find the optimum; None where no x satisfies all rows."""
        self._solver.run()
        if self._solver.getModelStatus() != self._optimal:
            return None
        found = self._solver.getSolution()
        return Optimum(
            float(self._solver.getObjectiveValue()),
            np.array(found.col_value),
            np.array(found.row_dual),
        )


# On one thread: the same program takes the same steps.
_OPTIONS = {
    "output_flag": False,
    "presolve": "off",
    "solver": "simplex",
    "threads": 1,
    "parallel": "off",
}
