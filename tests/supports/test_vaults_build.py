"""Whole hollowable volumes, vaulted: closed forms, properties, and spot in the real slicer."""

from __future__ import annotations

import math
from typing import get_args

import numpy as np
import pytest
from dev_hollowable import hollowable_of
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box
from support_inside import support_inside_g

from printprep.errors import UsageError
from printprep.mesh.measure import arrays, shells
from printprep.mesh.quantize import quantized
from printprep.mesh.self_intersections import self_intersections
from printprep.overhang.limits import acceptance
from printprep.overhang.rule import unsupported_ceilings
from printprep.profiles import load_profile
from printprep.supports import Vaults, vaulted
from printprep.types import VaultRule

PROFILE = load_profile("fdm-pla-0.4")
RULES = pytest.mark.parametrize("rule", get_args(VaultRule))


def holds(hollowable_volume: Manifold, vaults: Vaults, rule: VaultRule) -> None:
    """What is true of any vaulted volume."""
    assert vaults.unsupported_mm2 == 0 and vaults.islands == 0
    assert (vaults.cavity - hollowable_volume).volume() == pytest.approx(
        0, abs=0.01 * hollowable_volume.surface_area() / 100
    )
    assert vaults.added_mm3 == pytest.approx(
        hollowable_volume.volume() - vaults.cavity.volume(), abs=1e-6
    )
    if vaults.cavity.is_empty():
        return
    low, high = np.reshape(hollowable_volume.bounding_box(), (2, 3))
    shell = Manifold.cube((high - low + 4).tolist()).translate((low - 2).tolist())
    part = quantized(shell - vaults.cavity)
    solids, voids = shells(part)
    assert len(solids) == 1
    assert sum(v.volume() for v in voids) == pytest.approx(vaults.cavity.volume(), rel=1e-5)
    for phase in (0.0, 0.25, 0.8):
        written = [
            unsupported_ceilings(void, acceptance(PROFILE, rule), (phase,)) for void in voids
        ]
        assert sum(found.area_mm2 for found in written) < 0.05
        assert sum(found.islands for found in written) == 0


@pytest.mark.parametrize(("rule", "deg"), [("slicer", 35), ("printer", 50)])
def test_a_roof_within_the_limit_needs_nothing(rule, deg):
    height = 10 / math.tan(math.radians(deg))
    hollowable_volume = Manifold.cylinder(height, 10, 0, 128).translate((0, 0, 2))
    vaults = vaulted(hollowable_volume, PROFILE, rule)
    assert (vaults.samples, vaults.capitals, vaults.columns, vaults.added_mm3) == (0, 0, 0, 0)
    assert vaults.cavity.volume() == hollowable_volume.volume()


@RULES
def test_a_ball_gets_a_vault_under_its_cap(rule):
    hollowable_volume = Manifold.sphere(12, 128).translate((0, 0, 14))
    vaults = vaulted(hollowable_volume, PROFILE, rule)
    holds(hollowable_volume, vaults, rule)
    assert 0.01 < vaults.added_mm3 / hollowable_volume.volume() < 0.2


@RULES
def test_a_box_with_a_flat_ceiling(rule):
    hollowable_volume = box(16, 12, 12).translate((0, 0, 2))
    vaults = vaulted(hollowable_volume, PROFILE, rule)
    holds(hollowable_volume, vaults, rule)
    section = vaults.cavity.slice(14 - 1e-3)
    assert section.area() < 0.02 * 16 * 12  # the ceiling has all but gone
    assert section.offset(-acceptance(PROFILE, rule).off_mm).is_empty()  # what is left is bridged


def test_nothing_hollowable_no_vaults():
    vaults = vaulted(Manifold(), PROFILE, "printer")
    assert vaults.cavity.is_empty() and vaults.added_mm3 == 0


@RULES
def test_it_comes_out_the_same_twice(rule):
    hollowable_volume = Manifold.sphere(9, 64).translate((0, 0, 12))
    first, second = (
        vaulted(hollowable_volume, PROFILE, rule),
        vaulted(hollowable_volume, PROFILE, rule),
    )
    assert np.array_equal(
        first.cavity.to_mesh64().vert_properties, second.cavity.to_mesh64().vert_properties
    )


def test_a_printer_lays_more_than_a_slicer_leaves_without_support():
    hollowable_volume = Manifold.sphere(18, 128).translate((0, 0, 20))
    few, many = (vaulted(hollowable_volume, PROFILE, rule) for rule in ("printer", "slicer"))
    assert few.columns < 0.7 * many.columns and few.added_mm3 < 0.7 * many.added_mm3
    assert min(few.thinnest_mm, many.thinnest_mm) >= 1.15


def test_resin_has_no_vaults():
    with pytest.raises(UsageError, match="resin"):
        vaulted(box(9, 9, 9), load_profile("resin-standard"), "slicer")


@examples(8)
@given(
    st.floats(3, 9),
    st.floats(3, 9),
    st.floats(3, 9),
    st.floats(0, 90),
    st.floats(0, 90),
    st.sampled_from(get_args(VaultRule)),
)
def test_any_ellipsoid_is_carried(a, b, c, tilt, turn, rule):
    hollowable_volume = (
        Manifold.sphere(1, 48).scale((a, b, c)).rotate((tilt, 0, turn)).translate((0, 0, 14))
    )
    holds(hollowable_volume, vaulted(hollowable_volume, PROFILE, rule), rule)


@pytest.mark.corpus
@pytest.mark.slicer
@pytest.mark.usefixtures("prusa_slicer")
def test_spot_prints_without_support_inside_even_without_a_blocker(dev_models):
    rule: VaultRule = "slicer"
    spot = dev_models["spot_low_resolution"]
    solid, hollowable_volume = hollowable_of(spot.path, spot.up, 50.0, PROFILE)
    vaults = vaulted(hollowable_volume, PROFILE, rule)
    holds(hollowable_volume, vaults, rule)
    assert vaults.added_mm3 / hollowable_volume.volume() < 0.12
    plain = support_inside_g(solid, hollowable_volume, PROFILE, 45)
    assert plain > 0.5
    for threshold in (0, 45):
        assert support_inside_g(solid, vaults.cavity, PROFILE, threshold) < 0.1


@pytest.mark.corpus
@RULES
def test_a_hundred_capitals_leave_no_slivers_that_fold_over(rule, dev_models):
    """Left as the kernel makes them, one went 0.14 mm through the surface beside it."""
    spot = dev_models["spot_low_resolution"]
    solid, hollowable_volume = hollowable_of(spot.path, spot.up, 100.0, PROFILE)
    part = quantized(solid - vaulted(hollowable_volume, PROFILE, rule).cavity)
    vertices, faces = arrays(part)
    assert len(self_intersections(vertices, faces).face) == 0
    corners = vertices[faces]
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
    away = corners[:, 1:] - corners[:, :1]
    doubled = np.linalg.norm(np.cross(away[:, 0], away[:, 1]), axis=1)
    assert (doubled / sides.max(axis=1) < 1e-5).mean() < 0.001
