"""The rule on support blockers: silent on ours, exact on one too small and on one too large."""

from __future__ import annotations

import pytest
from closed_form_parts import box, context, hollow_box, roofed

from printprep.check.support_blocker import support_blocker
from printprep.check.unsupported_ceiling import unsupported_ceiling
from printprep.overhang.limits import slicer_acceptance


def test_a_blocker_between_its_limits_is_silent(fdm):
    blocker = box(18, z=1)  # half of the wall of 2 mm
    assert not list(support_blocker(context(hollow_box(20, 2), blocker=blocker), fdm))


def test_a_blocker_as_large_as_the_cavity_leaves_its_ceiling_bare(fdm):
    """The ceiling's layer lies above the cavity."""
    (finding,) = support_blocker(context(hollow_box(20, 2), blocker=box(16, z=2)), fdm)
    side = 16 - 2 * slicer_acceptance(fdm).off_mm
    assert finding.severity == "warning"
    assert finding.value == pytest.approx(side**2, rel=1e-3)
    assert finding.at_mm == pytest.approx((0, 0, 18), abs=0.2)


def test_a_blocker_as_large_as_the_part_covers_overhangs_outside(fdm):
    (finding,) = support_blocker(context(hollow_box(20, 2), blocker=box(20)), fdm)
    assert "outside" in finding.message


def test_a_blocker_around_an_open_cavity_is_judged_by_its_bounds(fdm):
    part = hollow_box(20, 2) - box(3, 6, z=-1)
    assert not list(support_blocker(context(part, blocker=box(18, z=1) - box(4, 6, z=-1)), fdm))
    (finding,) = support_blocker(context(part, blocker=box(20)), fdm)
    assert "outside" in finding.message


def test_without_a_blocker_or_without_filament_there_is_nothing_to_say(fdm, resin):
    assert not list(support_blocker(context(hollow_box(20, 2)), fdm))
    assert not list(support_blocker(context(hollow_box(20, 2), blocker=box(20)), resin))


@pytest.mark.parametrize(("deg", "blocked", "silent"), [
    (30, False, True), (45, False, False), (45, True, True), (50, True, True), (60, True, False),
])  # fmt: skip
def test_a_blocked_ceiling_is_judged_by_the_printer(fdm, deg, blocked, silent):
    part = context(roofed(deg), blocker=box(18, z=1) if blocked else None)
    assert (not list(unsupported_ceiling(part, fdm))) is silent
