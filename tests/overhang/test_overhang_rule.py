"""The acceptance rule on voids and solids whose overhangs are known by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box, cylinder

from printprep.overhang.limits import Acceptance, slicer_acceptance
from printprep.overhang.rule import unsupported_ceilings, unsupported_overhangs
from printprep.profiles import load_profile

RULE = slicer_acceptance(load_profile("fdm-pla-0.4"))
PHASES = np.arange(0, 1, 0.05)


def gable(deg: float, half: float = 6.0, length: float = 10.0) -> Manifold:
    """A void under a ridge roof: its sides lean ``deg`` from the vertical and meet in an edge."""
    rise = half / math.tan(math.radians(deg))
    profile = [(-half, 2.0), (half, 2.0), (0.0, 2.0 + rise)]
    ends = [(x, y, z) for y in (-length / 2, length / 2) for x, z in profile]
    return Manifold.hull_points(np.array(ends))


def chimney(deg: float, radius: float = 6.0) -> Manifold:
    """A void that narrows upward to a point."""
    rise = radius / math.tan(math.radians(deg))
    return Manifold.cylinder(rise, radius, 0.0, 96).translate((0, 0, 2))


def accepted(void: Manifold, rule: Acceptance = RULE) -> bool:
    """At every place of the layers."""
    return all(not unsupported_ceilings(void, rule, (float(p),)).patches for p in PHASES)


@pytest.mark.parametrize("shape", [gable, chimney])
@pytest.mark.parametrize(("deg", "good"), [(20, True), (35, True), (35.6, True)])
def test_roofs_within_the_limit_are_accepted(shape, deg, good):
    assert accepted(shape(deg)) is good


@pytest.mark.parametrize("shape", [gable, chimney])
@pytest.mark.parametrize("deg", [39, 40, 44])
def test_roofs_beyond_the_limit_are_refused_for_closing_early(shape, deg):
    assert not accepted(shape(deg))


def test_a_gable_is_refused_by_what_the_closed_ridge_leaves():
    """Half width x below the layer that closes: x − off remains on each side of the ridge.

    The layer that closes has a half width just below c, so x is at most h tan θ + c.
    """
    half = RULE.layer_mm * math.tan(math.radians(44)) + RULE.closing_mm
    most = max(unsupported_ceilings(gable(44), RULE, (float(p),)).area_mm2 for p in PHASES)
    bound = 2 * (half - RULE.off_mm) * 10.0
    assert 0.6 * bound < most <= bound


def test_a_flat_ceiling_is_flagged_but_for_its_rim():
    found = unsupported_ceilings(box(10, 10, 6).translate((0, 0, 1)), RULE)
    (patch,) = found.patches
    side = 10 - 2 * RULE.off_mm
    assert found.area_mm2 == pytest.approx(side**2, rel=1e-3)
    assert patch.at_mm == pytest.approx((0, 0, 7.0), abs=1e-3)
    assert not patch.island


@pytest.mark.parametrize(("reach", "good"), [(0.18, True), (0.21, False)])
def test_a_ledge_may_reach_as_far_as_off(reach, good):
    wide = box(10, 10, 4)
    narrow = box(10 - 2 * reach, 10 - 2 * reach, 4).translate((0, 0, 3))
    found = unsupported_ceilings((wide + narrow).translate((0, 0, 1)) - box(30, 30, 1.5), RULE)
    ledges = [patch for patch in found.patches if patch.z_mm < 6]
    assert (not ledges) is good


@pytest.mark.parametrize(("under", "islands"), [(3.0, 1), (0.0, 0)])
def test_what_hangs_in_a_cavity_is_an_island_until_something_stands_below(under, islands):
    room = Manifold.cylinder(12, 8, 0.5, 96).translate((0, 0, 1))
    column = cylinder(1.0, 30).translate((0, 0, under))
    assert unsupported_ceilings(room - column, RULE).islands == islands


def test_a_widening_column_is_no_island():
    """Its upper section rings the lower one: all new at the rim, but not within."""
    room = box(20, 20, 4).translate((0, 0, 1))
    column = Manifold.cylinder(8, 1.0, 1.0 + 8 * math.tan(math.radians(30)), 48)
    found = unsupported_ceilings(room - column, RULE)
    assert found.islands == 0
    assert all(patch.z_mm > 4.5 for patch in found.patches)


@pytest.mark.parametrize("phase", [0.0, 0.3, 0.7])
def test_voids_and_material_are_judged_alike(phase):
    void = Manifold.sphere(8, 64).translate((0, 0, 12)) - Manifold.cylinder(30, 1, 1, 16)
    part = box(24, 24, 24) - void
    quick = unsupported_ceilings(void, RULE, (phase,))
    slow = unsupported_overhangs(part, RULE, phase)
    assert quick.area_mm2 == pytest.approx(slow.area_mm2, rel=2e-3)
    assert quick.islands == slow.islands == 0


def test_a_mushroom_s_cap_is_flagged_outside():
    part = cylinder(2, 6) + cylinder(6, 2).translate((0, 0, 5))
    found = unsupported_overhangs(part, RULE)
    ring = math.pi * (36 - (2 + RULE.off_mm) ** 2)
    assert found.area_mm2 == pytest.approx(ring, rel=0.01)


def test_a_floating_block_is_an_island():
    part = box(4, 4, 2) + box(2, 2, 2).translate((0, 0, 4))
    (patch,) = unsupported_overhangs(part, RULE).patches
    assert patch.island
    assert patch.area_mm2 == pytest.approx(4.0, abs=1e-3)
    assert patch.at_mm == pytest.approx((0, 0, 4.0), abs=0.01)


def test_nothing_is_flagged_of_nothing():
    assert unsupported_ceilings(Manifold(), RULE).patches == ()
    assert unsupported_overhangs(Manifold(), RULE).worst is None


@given(st.floats(5, 35), st.floats(0, 0.99), st.floats(0, 360))
def test_no_roof_within_the_limit_is_flagged(deg, phase, turn):
    roof = gable(deg).rotate((0, 0, turn))
    assert not unsupported_ceilings(roof, RULE, (phase,)).patches
