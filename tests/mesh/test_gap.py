"""The least distance between an outside and what lies in it, measured on all of it or on little."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold

from printprep.mesh import gap
from printprep.mesh.gap import gap_mm


@pytest.fixture(params=["all", "some"])
def _measured(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """All triangles of the outside are measured, or those that can be nearest."""
    monkeypatch.setattr(gap, "MANY", 0 if request.param == "some" else 10**9)
    monkeypatch.setattr(gap, "FEW_SHARE", 1.0)


def _box(low: float, high: float) -> Manifold:
    return Manifold.cube([high - low] * 3).translate([low] * 3)


@pytest.mark.usefixtures("_measured")
@pytest.mark.parametrize("finer", [1, 7])
def test_a_box_in_a_box(finer: int) -> None:
    outside = _box(0, 20).refine(finer)
    assert gap_mm(outside, _box(1.5, 17), 5.0) == pytest.approx(1.5, abs=2e-6)
    assert gap_mm(outside, _box(1.5, 17), 1.0) == 1.0
    assert gap_mm(outside, _box(6, 14), 5.0) == 5.0
    assert gap_mm(outside, Manifold(), 5.0) == 5.0


@pytest.mark.usefixtures("_measured")
def test_two_edges_that_cross_are_nearest_between_their_corners() -> None:
    # A wedge with its edge along x at z = 0, upside down above a ridge along y at z = −1.25
    outside = _box(-20, 20) - _tent().rotate([180, 0, 0]).translate([0, 0, 10])
    inside = _tent().scale([0.5, 0.5, 0.5]).rotate([0, 0, 90]).translate([0, 0, -6.25])
    assert gap_mm(outside, inside, 5.0) == pytest.approx(1.25, abs=2e-6)


def _tent() -> Manifold:
    """A prism along x from −8 to 8, with its ridge at z = 10."""
    corners = [[x, y, z] for x in (-8, 8) for y, z in ((-3, 0), (3, 0), (0, 10))]
    return Manifold.hull_points(np.array(corners, dtype=float))


@pytest.mark.usefixtures("_measured")
@pytest.mark.parametrize("apart_mm", [3.0, 15.0])
def test_it_is_zero_where_one_breaks_through(apart_mm: float) -> None:
    inside = _box(5, 10).translate([20 - 10 + apart_mm, 0, 0])
    assert gap_mm(_box(0, 20), inside, 5.0) == 0.0


def test_where_most_can_be_nearest_all_are_measured(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(corners: np.ndarray) -> Manifold:
        raise AssertionError(f"{len(corners)} triangles are measured one by one")

    monkeypatch.setattr(gap, "MANY", 0)
    monkeypatch.setattr(gap, "_thin_tetrahedra", refuse)
    assert gap_mm(_box(0, 20), _box(1.5, 18.5), 5.0) == pytest.approx(1.5, abs=2e-6)


@pytest.mark.parametrize("seed", range(12))
def test_both_ways_agree_on_random_solids(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rng = np.random.default_rng(seed)
    outside = Manifold.sphere(20, int(rng.integers(8, 40)))
    outside += Manifold.cube([30, 10, 25]).rotate(rng.uniform(0, 90, 3).tolist())
    outside = outside.refine(int(rng.integers(1, 4)))
    inside = Manifold.sphere(17.5, int(rng.integers(8, 40))).rotate(rng.uniform(0, 90, 3).tolist())
    inside = inside.translate(rng.uniform(-0.9, 0.9, 3).tolist())
    for at_most_mm in (0.5, 1.5, 4.0):
        monkeypatch.setattr(gap, "MANY", 10**9)
        whole = gap_mm(outside, inside, at_most_mm)
        monkeypatch.setattr(gap, "MANY", 0)
        monkeypatch.setattr(gap, "FEW_SHARE", 1.0)
        assert gap_mm(outside, inside, at_most_mm) == pytest.approx(whole, abs=2e-6)
