"""The steepest overhang, against figures measured with PrusaSlicer 2.5.0."""

from __future__ import annotations

import math

import pytest

from printprep.errors import UsageError
from printprep.overhang.limits import Acceptance, acceptance
from printprep.profiles import load_profile
from printprep.supports.member_sizes import MemberSizes


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
    assert acceptance(profile).steepest_deg == pytest.approx(deg, abs=0.01)


def test_the_profile_caps_the_angle():
    profile = load_profile("fdm-pla-0.4", {"overhang_deg": 30.0})
    assert MemberSizes.of(profile).theta_deg == 30.0


def test_thinner_lines_reach_less_far():
    thin = load_profile("fdm-pla-0.4", {"printer.line_width_mm": 0.35})
    assert acceptance(thin).off_mm == pytest.approx(0.175)


def test_where_nothing_is_extruded_there_is_no_rule():
    with pytest.raises(UsageError, match="resin-standard is for resin"):
        acceptance(load_profile("resin-standard"))
