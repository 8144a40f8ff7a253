"""Linear programs with columns that arrive one by one, against another solver and closed forms."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from printprep.density.column_program import INFINITE, ColumnProgram


def test_the_cheaper_of_two_is_taken_and_the_row_names_its_price() -> None:
    # 2x + 3y at least 6: x costs 4 for 2, y costs 3 for 3
    program = ColumnProgram(
        np.array([4.0]),
        np.array([[2.0]]),
        rows=(np.array([6.0]), np.array([INFINITE])),
        bounds=(np.zeros(1), np.full(1, INFINITE)),
    )
    alone = program.solve()
    assert alone is not None
    assert (alone.cost, alone.x.tolist(), alone.multipliers.tolist()) == (12.0, [3.0], [2.0])
    program.add(3.0, np.array([3.0]))
    both = program.solve()
    assert both is not None
    assert (both.cost, both.x.tolist(), both.multipliers.tolist()) == (6.0, [0.0, 2.0], [1.0])


def test_rows_that_no_x_satisfies_give_none() -> None:
    program = ColumnProgram(
        np.ones(2),
        np.array([[1.0, 1.0]]),
        rows=(np.array([3.0]), np.array([INFINITE])),
        bounds=(np.zeros(2), np.ones(2)),
    )
    assert program.solve() is None


@given(seed=st.integers(0, 2**32 - 1), rows=st.integers(1, 12), columns=st.integers(1, 20))
def test_columns_that_arrive_later_change_nothing(seed: int, rows: int, columns: int) -> None:
    rng = np.random.default_rng(seed)
    costs, matrix = rng.uniform(0.1, 2, columns), rng.normal(size=(rows, columns))
    least = np.minimum(rng.normal(size=rows), matrix @ rng.uniform(size=columns))
    upper = np.full(rows, INFINITE)
    first = int(rng.integers(1, columns + 1))
    program = ColumnProgram(
        costs[:first],
        matrix[:, :first],
        rows=(least, upper),
        bounds=(np.zeros(first), np.full(first, INFINITE)),
    )
    program.solve()
    for column in range(first, columns):
        program.add(float(costs[column]), matrix[:, column])
        program.solve()
    found = program.solve()
    other = linprog(costs, A_ub=-matrix, b_ub=-least, method="highs")
    assert found is not None
    assert found.cost == pytest.approx(other.fun, rel=1e-9, abs=1e-12)
    assert (matrix @ found.x >= least - 1e-6).all()
    # Weak duality: the multipliers prove the cost
    assert (found.multipliers >= -1e-9).all()
    assert (costs - found.multipliers @ matrix >= -1e-6).all()
    assert found.multipliers @ least == pytest.approx(found.cost, rel=1e-6, abs=1e-9)


def test_the_solver_prints_nothing() -> None:
    program = (
        "import numpy as np\n"
        "from printprep.density.column_program import ColumnProgram\n"
        "one = np.ones(1)\n"
        "ColumnProgram(one, np.eye(1), rows=(one, one), bounds=(0 * one, one)).solve()\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, check=True, timeout=120
    )
    assert (done.stdout, done.stderr) == (b"", b"")
