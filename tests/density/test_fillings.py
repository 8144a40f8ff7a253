"""The lean program against a second solver, and the certificate against what it claims."""

from __future__ import annotations

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import linprog

from printprep.density.fillings import Fillings
from printprep.density.lean import largest_lean, separating_plane, solve_lean
from printprep.stand.footing import Footing


def random_problem(seed: int) -> tuple[np.ndarray, np.ndarray, Footing]:
    """Voxels (4, n), fixed moments (4,) and a footing: a random blob on a random polygon."""
    rng = np.random.default_rng(seed)
    n = int(rng.integers(5, 250))
    where = rng.normal(size=(n, 3)) * [10, 10, 15] + [*rng.normal(size=2) * 6, 40]
    where[:, 2] = np.abs(where[:, 2]) + 0.5
    mass = rng.uniform(0.2, 1.0, n)
    voxels = np.vstack([mass, mass * where.T])
    total = rng.uniform(0.2, 2.0) * mass.sum()
    fixed = total * np.array([1.0, *(rng.normal(size=2) * 4), rng.uniform(5, 50)])
    angles = np.sort(rng.uniform(0, 2 * np.pi, int(rng.integers(3, 12))))
    normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return voxels, fixed, Footing(normals, rng.uniform(3, 12, len(angles)))


def full_program(voxels: np.ndarray, fixed: np.ndarray, rows: np.ndarray) -> float | None:
    """Least mass by HiGHS on every voxel at once, None when infeasible."""
    result = linprog(
        voxels[0], A_ub=-rows @ voxels, b_ub=rows @ fixed, bounds=(0, 1), method="highs"
    )
    return float(result.fun + fixed[0]) if result.status == 0 else None


@pytest.mark.parametrize("seed", range(200))
def test_a_second_solver_agrees(seed: int) -> None:
    voxels, fixed, footing = random_problem(seed)
    rows = footing.constraints(10.0)
    ours = Fillings(voxels).lightest(fixed, rows)
    theirs = full_program(voxels, fixed, rows)
    if theirs is None:
        assert ours is None
        return
    assert ours is not None
    assert ours.moments[0] == pytest.approx(theirs, rel=1e-7)
    assert ours.bound == pytest.approx(theirs, rel=1e-7)


@examples(60)
@given(st.integers(0, 2**32 - 1))
def test_the_filling_is_what_the_certificate_says(seed: int) -> None:
    voxels, fixed, footing = random_problem(seed)
    rows = footing.constraints(8.0)
    found = Fillings(voxels).lightest(fixed, rows)
    if found is None:
        return
    assert np.all((found.rho >= 0) & (found.rho <= 1))
    np.testing.assert_allclose(found.moments, fixed + voxels @ found.rho, rtol=1e-12)
    scale = np.abs(rows @ found.moments).max()
    assert np.all(rows @ found.moments >= -1e-9 * scale)
    assert found.moments[0] - found.bound <= 1e-6 * found.moments[0]
    # A vertex of the program: no more fractional voxels than constraints that bind.
    fractional = np.count_nonzero((found.rho > 1e-9) & (found.rho < 1 - 1e-9))
    assert fractional <= 4


@examples(60)
@given(st.integers(0, 2**32 - 1))
def test_the_optimum_is_a_half_space_with_an_upward_normal(seed: int) -> None:
    voxels, fixed, footing = random_problem(seed)
    found = Fillings(voxels).lightest(fixed, footing.constraints(10.0))
    if found is None:
        return
    plane = separating_plane(found, footing, 10.0)
    if plane is None:
        assert not found.rho.any()
        return
    where = voxels[1:] / voxels[0]
    above = np.array(plane.normal) @ where - plane.offset_mm
    assert plane.normal[2] > 0
    assert np.all(found.rho[above > 1e-6] < 1e-6)
    assert np.all(found.rho[above < -1e-6] > 1 - 1e-6)


@examples(60)
@given(st.integers(0, 2**32 - 1))
def test_the_largest_lean_is_the_border_of_feasibility(seed: int) -> None:
    voxels, fixed, footing = random_problem(seed)
    reachable = largest_lean(Fillings(voxels), fixed, footing)
    assert full_program(voxels, fixed, footing.constraints(reachable + 0.01)) is None
    assert full_program(voxels, fixed, footing.constraints(reachable - 0.01)) is not None


def test_an_infeasible_lean_is_solved_at_nine_tenths_of_the_largest() -> None:
    voxels = np.array([[1.0], [0.0], [0.0], [10.0]])
    fixed = np.array([1.0, 0.0, 0.0, 20.0])
    square = Footing(np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]]), np.full(4, 2.0))
    # Full, the centre of mass is at 15: the largest lean is atan(2 / 15).
    largest = np.degrees(np.arctan(2 / 15))
    found = solve_lean(Fillings(voxels), fixed, square, 10.0)
    assert found.reachable_deg == pytest.approx(largest, abs=1e-6)
    assert found.aim_deg == pytest.approx(0.9 * largest, abs=1e-6)
    assert square.tangent(found.filling.moments) >= np.tan(np.radians(0.9 * largest)) - 1e-9


def test_a_body_that_no_filling_rights_stays_as_light_as_it_is() -> None:
    voxels = np.array([[1.0], [5.0], [0.0], [10.0]])
    fixed = np.array([1.0, 5.0, 0.0, 20.0])
    square = Footing(np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]]), np.full(4, 2.0))
    found = solve_lean(Fillings(voxels), fixed, square, 10.0)
    assert found.aim_deg is None and found.plane is None
    # Filling it lower would make it fall faster, so the largest lean is the empty body's.
    assert found.reachable_deg == pytest.approx(np.degrees(np.arctan(-3 / 20)), abs=1e-6)
    assert not found.filling.rho.any()


def test_nothing_is_filled_where_the_shell_stands_by_itself() -> None:
    voxels = np.array([[1.0], [0.0], [0.0], [1.0]])
    fixed = np.array([1.0, 0.0, 0.0, 1.0])
    square = Footing(np.array([[1.0, 0], [0, 1], [-1, 0], [0, -1]]), np.full(4, 5.0))
    found = solve_lean(Fillings(voxels), fixed, square, 10.0, 0.5)
    assert not found.filling.rho.any()
    assert found.plane is None
    assert (found.aim_deg, found.reachable_deg) == (10.5, None)
    assert found.filling.bound == 1.0
