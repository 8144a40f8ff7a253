"""The steepest overhang, against figures measured with PrusaSlicer 2.5.0."""

from __future__ import annotations

import math
from typing import get_args

import pytest

from printprep.errors import UsageError
from printprep.overhang.limits import Acceptance, printer_acceptance, slicer_acceptance
from printprep.profiles import load_profile
from printprep.supports.member_sizes import MemberSizes, built_for, slope_deg
from printprep.types import VaultRule


@pytest.mark.parametrize(
    ("layer_mm", "off_mm", "steepest_deg"),
    [  # the automatic threshold's off is half a line, that of 45° is h / tan 46°
        (0.2, 0.225, 41.35),
        (0.2, 0.2 / math.tan(math.radians(46)), 35.78),
        (0.3, 0.225, 30.40),
        (0.3, 0.3 / math.tan(math.radians(46)), 38.74),
    ],
)
def test_each_threshold_alone(layer_mm, off_mm, steepest_deg):
    rule = Acceptance(layer_mm, layer_mm, off_mm)
    assert rule.steepest_deg == pytest.approx(steepest_deg, abs=0.01)


@pytest.mark.parametrize(("layer_mm", "deg"), [(0.2, 35.78), (0.3, 30.40)])
def test_the_stricter_threshold_decides(layer_mm, deg):
    profile = load_profile("fdm-pla-0.4", {"printer.layer_height_mm": layer_mm})
    assert slicer_acceptance(profile).steepest_deg == pytest.approx(deg, abs=0.01)


def test_the_profile_caps_the_angle():
    profile = load_profile("fdm-pla-0.4", {"overhang_deg": 30.0})
    for rule in get_args(VaultRule):
        built = built_for(profile, rule)
        assert MemberSizes.of(profile, built).theta_deg <= 30.0
        assert slope_deg(built, profile.overhang_deg) <= 30.0


@pytest.mark.parametrize(
    ("settings", "off_mm"),
    [
        ({}, 0.667 * 0.45),
        ({"overhang.share": 0.5}, 0.225),
        ({"printer.line_width_mm": 0.5}, 0.667 * 0.5),
        # At thin layers the cap decides: 60° over 0.1 mm.
        ({"printer.layer_height_mm": 0.1}, 0.1 * math.sqrt(3)),
        ({"overhang_deg": 45.0}, 0.2),
    ],
)
def test_a_printer_lays_a_share_of_a_line_over_air(settings, off_mm):
    profile = load_profile("fdm-pla-0.4", settings)
    assert printer_acceptance(profile).off_mm == pytest.approx(off_mm)


def test_a_third_of_a_line_rests_on_the_one_below():
    """About 56° at layers of 0.2 mm and lines of 0.45 mm."""
    rule = printer_acceptance(load_profile("fdm-pla-0.4"))
    assert math.degrees(math.atan(rule.off_mm / rule.layer_mm)) == pytest.approx(56.3, abs=0.1)


def test_a_profile_without_a_share_takes_the_default():
    profile = load_profile("fdm-pla-0.4")
    without = profile.model_copy(update={"overhang": None})
    assert without.overhang_share == profile.overhang_share == 0.667


def test_overhangs_have_no_share_where_nothing_is_extruded():
    with pytest.raises(UsageError, match="overhang has no meaning for resin"):
        load_profile("resin-standard", {"overhang.share": 0.5})


def test_thinner_lines_reach_less_far():
    thin = load_profile("fdm-pla-0.4", {"printer.line_width_mm": 0.35})
    assert slicer_acceptance(thin).off_mm == pytest.approx(0.175)


def test_where_nothing_is_extruded_there_is_no_rule():
    with pytest.raises(UsageError, match="resin-standard is for resin"):
        slicer_acceptance(load_profile("resin-standard"))
    with pytest.raises(UsageError, match="resin-standard is for resin"):
        printer_acceptance(load_profile("resin-standard"))
