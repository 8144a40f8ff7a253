"""The lean program on a generator's voxels: lighter than the paper's, standing at the lean."""

from __future__ import annotations

import numpy as np
import pytest

from printprep.errors import UsageError
from printprep.generators import hollow
from printprep.paper.voxel_balance import tilt_deg


def leaning_tower() -> np.ndarray:
    """(64, 64, 64) bool: a square tower whose layers step toward +x."""
    tower = np.zeros((64, 64, 64), dtype=bool)
    for z in range(40):
        x = 16 + z // 4
        tower[x : x + 16, 20:36, 8 + z] = True
    return tower


def test_the_lightest_that_stands_at_the_lean_is_lighter_than_the_papers() -> None:
    lean = hollow(leaning_tower(), objective="lean", lean_deg=6.0)
    paper = hollow(leaning_tower(), objective="paper")
    assert lean.mass_ratio < paper.mass_ratio
    assert tilt_deg(lean.density, lean.domain.ground) >= 6.0 - 1e-6
    # Shell and outside stay: only interior and base may differ.
    assert (lean.material_voxels | lean.cavity_voxels)[lean.domain.solid].all()


def test_a_solver_of_the_paper_is_refused_for_the_lean() -> None:
    with pytest.raises(UsageError, match="solver"):
        hollow(leaning_tower(), objective="lean", solver="adam")
    with pytest.raises(UsageError, match="lean of 70"):
        hollow(leaning_tower(), objective="lean", lean_deg=70.0)
