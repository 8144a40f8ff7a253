"""The rule that reports unsupported ceilings: silent on roofs, exact on a flat ceiling."""

from __future__ import annotations

import pytest
from closed_form_parts import box, context, hollow_box, roofed

from printprep.check.unsupported_ceiling import unsupported_ceiling
from printprep.overhang.limits import slicer_acceptance


def test_a_flat_ceiling_is_reported_with_its_area_and_place(fdm):
    (finding,) = unsupported_ceiling(context(hollow_box(20, 2)), fdm)
    side = 16 - 2 * slicer_acceptance(fdm).off_mm
    assert finding.severity == "warning"
    assert finding.value == pytest.approx(side**2, rel=1e-3)
    assert finding.at_mm == pytest.approx((0, 0, 18), abs=0.2)


@pytest.mark.parametrize(("deg", "silent"), [(30, True), (35, True), (60, False)])
def test_roofs_on_both_sides_of_the_limit(fdm, deg, silent):
    assert (not list(unsupported_ceiling(context(roofed(deg)), fdm))) is silent


def test_a_piece_that_hangs_in_a_cavity_is_reported_however_small(fdm):
    part = roofed(30) + box(0.6, 1.0, z=5.0)
    (finding,) = unsupported_ceiling(context(part), fdm)
    assert "1 island" in finding.message
    assert finding.at_mm == pytest.approx((0, 0, 5), abs=0.2)


def test_other_processes_print_any_ceiling(resin, powder):
    for profile in (resin, powder):
        assert not list(unsupported_ceiling(context(hollow_box(20, 2)), profile))


def test_a_solid_has_no_ceilings(fdm):
    assert not list(unsupported_ceiling(context(box(20)), fdm))
