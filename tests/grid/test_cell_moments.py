"""Volume and centroid per cell: exact for boxes on the lines' grid, converging for balls."""

from __future__ import annotations

import numpy as np
import pytest
import solids
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.grid.cell_moments import moments_in_cells
from printprep.grid.grid import grid_over
from printprep.mesh.measure import mass_properties


def test_a_box_is_exact_in_height_and_in_its_cells() -> None:
    grid = grid_over(np.array([-8.0, -8, 0]), np.array([8.0, 8, 16]), 8)
    box = Manifold.cube((4.0, 6.0, 5.3)).translate((-8.0, -8.0, 1.1))
    volume, mx, my, mz = moments_in_cells(box, grid)
    assert volume.sum() == pytest.approx(4 * 6 * 5.3)
    assert mz.sum() == pytest.approx(4 * 6 * 5.3 * 3.75)
    # Across, lines are somewhere in their part of a cell.
    assert (mx.sum(), my.sum()) == pytest.approx((4 * 6 * 5.3 * -6, 4 * 6 * 5.3 * -5), rel=0.01)
    # The lowest layer of cells, 2 mm high, is entered at 1.1 mm.
    assert volume[0, 0, 0] == pytest.approx(2 * 2 * 0.9)
    assert volume[0, 0, 1] == pytest.approx(8.0)


def test_a_ball_with_a_void() -> None:
    shell = solids.sphere(10) - solids.sphere(5).translate((0, 0, 5))
    grid = grid_over(np.array([-10.0, -10, 0]), np.array([10.0, 10, 20]), 16)
    volume, *moments = moments_in_cells(shell, grid)
    exact = mass_properties(shell)
    assert volume.sum() == pytest.approx(exact.volume_mm3, rel=3e-3)
    np.testing.assert_allclose(
        [row.sum() / volume.sum() for row in moments], exact.centre_mm, atol=0.03
    )
    assert volume.max() <= grid.pitch_mm**3 * (1 + 1e-12)


@given(st.floats(0, 360), st.floats(0, 360))
def test_a_box_however_it_is_turned(x: float, z: float) -> None:
    box = solids.box(7, 9, 11).rotate((x, 0, z))
    low, high = np.reshape(box.bounding_box(), (2, 3))
    volume = moments_in_cells(box, grid_over(low, high, 16))[0].sum()
    assert volume == pytest.approx(7 * 9 * 11, rel=0.01)


def test_nothing_weighs_nothing() -> None:
    grid = grid_over(np.zeros(3), np.ones(3), 4)
    assert not moments_in_cells(Manifold(), grid).any()
