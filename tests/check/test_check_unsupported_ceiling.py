"""The rule that reports unsupported ceilings: silent on roofs, exact on a flat ceiling."""

from __future__ import annotations

import math
from collections.abc import Iterator
from types import ModuleType

import numpy as np
import pytest
from closed_form_parts import box, hollow_box, subject
from manifold3d import Manifold

from printprep.check import registry
from printprep.overhang.limits import acceptance


@pytest.fixture
def rule(monkeypatch: pytest.MonkeyPatch) -> Iterator[ModuleType]:
    """The rule's module, registered for this test only unless it is registered for good."""
    monkeypatch.setattr(registry, "_RULES", dict(registry._RULES))
    from printprep.check import unsupported_ceiling

    yield unsupported_ceiling


def roofed(deg: float, size: float = 20.0, wall: float = 2.0) -> Manifold:
    """A block with a cavity under a pyramid whose sides lean ``deg`` from the vertical."""
    half = size / 2 - wall
    rise = half / math.tan(math.radians(deg))
    floor = [(x, y, wall) for x in (-half, half) for y in (-half, half)]
    return box(size, wall + rise + wall) - Manifold.hull_points(
        np.array([*floor, (0.0, 0.0, wall + rise)])
    )


def test_a_flat_ceiling_is_reported_with_its_area_and_place(rule, fdm):
    (finding,) = rule.unsupported_ceiling(subject(hollow_box(20, 2)), fdm)
    side = 16 - 2 * acceptance(fdm).off_mm
    assert finding.severity == "warning"
    assert finding.value == pytest.approx(side**2, rel=1e-3)
    assert finding.at_mm == pytest.approx((0, 0, 18), abs=0.2)


@pytest.mark.parametrize(("deg", "silent"), [(30, True), (35, True), (60, False)])
def test_roofs_on_both_sides_of_the_limit(rule, fdm, deg, silent):
    assert (not list(rule.unsupported_ceiling(subject(roofed(deg)), fdm))) is silent


def test_a_piece_that_hangs_in_a_cavity_is_reported_however_small(rule, fdm):
    part = roofed(30) + box(0.6, 1.0, z=5.0)
    (finding,) = rule.unsupported_ceiling(subject(part), fdm)
    assert "1 piece" in finding.message
    assert finding.at_mm == pytest.approx((0, 0, 5), abs=0.2)


def test_other_processes_print_any_ceiling(rule, resin, powder):
    for profile in (resin, powder):
        assert not list(rule.unsupported_ceiling(subject(hollow_box(20, 2)), profile))


def test_a_solid_has_no_ceilings(rule, fdm):
    assert not list(rule.unsupported_ceiling(subject(box(20)), fdm))
