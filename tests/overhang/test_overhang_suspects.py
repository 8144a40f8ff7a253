"""Suspects: none on what always passes, and with them the rule flags what it flags without."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box

from printprep.overhang.limits import acceptance
from printprep.overhang.rule import unsupported_ceilings, unsupported_overhangs
from printprep.overhang.suspects import Suspects
from printprep.profiles import load_profile

RULE = acceptance(load_profile("fdm-pla-0.4"))
LIMIT_DEG = RULE.steepest_deg


def hanging(corners: list[tuple[float, float, float]], size: float = 20.0) -> Manifold:
    """A room with a piece that hangs from its ceiling, steep-sided but for its lower end."""
    room = box(size, size, 20).translate((0, 0, 1))
    return room - Manifold.hull_points(np.array(corners))


def keel(rise: float) -> Manifold:
    """It hangs down in an edge that climbs by ``rise`` over 10 mm, to a ceiling at 21 mm."""
    ridge = [(-5.0, 0.0, 8.0), (5.0, 0.0, 8.0 + rise)]
    roots = [(x, y, 22.0) for x in (-5.0, 5.0) for y in (-3.0, 3.0)]
    return hanging([*ridge, *roots])


@pytest.mark.parametrize(("past_deg", "many"), [(-0.01, 0), (0.01, 5)])
def test_faces_count_from_the_limit_on(past_deg, many):
    """The four faces of a roof, and their tip, from which then nothing is a way down."""
    half = 5.0
    rise = half / math.tan(math.radians(LIMIT_DEG + past_deg))
    floor = [(x, y, 1.0) for x in (-half, half) for y in (-half, half)]
    pyramid = Manifold.hull_points(np.array([*floor, (0.0, 0.0, 1.0 + rise)]))
    assert len(Suspects.of(pyramid, RULE)) == many


def test_a_level_keel_between_steep_faces_is_found():
    boxes = Suspects.of(keel(0.0), RULE)
    below = boxes.high_mm[:, 2] < 9
    assert below.any()
    assert boxes.low_mm[below].min(axis=0) == pytest.approx((-5, 0, 8))
    assert boxes.high_mm[below].max(axis=0) == pytest.approx((5, 0, 8))


def test_of_a_steep_keel_only_the_tip_is_found():
    steep = 10.0 / math.tan(math.radians(LIMIT_DEG))
    boxes = Suspects.of(keel(steep), RULE)
    below = boxes.high_mm[:, 2] < 9
    assert boxes.low_mm[below].tolist() == boxes.high_mm[below].tolist() == [[-5.0, 0.0, 8.0]]


def test_a_box_on_its_side_has_no_suspect_walls():
    boxes = Suspects.of(box(5, 5, 5), RULE)
    assert boxes.low_mm[:, 2].min() == 5  # the ceiling alone


def test_near_keeps_what_meets_a_box():
    boxes = Suspects.of(box(5, 5, 5) + box(5, 5, 9).translate((20, 0, 0)), RULE)
    kept = boxes.near(np.array([[15.0, -9, 0]]), np.array([[30.0, 9, 20]]))
    assert 0 < len(kept) < len(boxes)
    assert kept.low_mm[:, 2].min() == 9


@settings(max_examples=15)
@given(st.integers(0, 10**6), st.sampled_from([0.0, 0.3, 0.7]))
def test_the_rule_flags_the_same_as_word_by_word(seed, phase):
    """Random rooms: blocks of balls, cones and boxes less others, ceilings of every kind."""
    rng = np.random.default_rng(seed)

    def piece() -> Manifold:
        kind, size = rng.integers(3), rng.uniform(2, 6)
        shape = (
            Manifold.sphere(size, 24)
            if kind == 0
            else Manifold.cylinder(2 * size, size, float(rng.uniform(0, size)), 24, True)
            if kind == 1
            else Manifold.cube(rng.uniform(2, 8, 3).tolist(), True)
        )
        turned = shape.rotate(rng.uniform(0, 360, 3).tolist())
        return turned.translate((rng.uniform(-5, 5, 3) + np.array([0, 0, 16])).tolist())

    void = (piece() + piece() + piece()) - piece() - piece()
    part = box(50, 50, 40) - void
    quick = unsupported_ceilings(void, RULE, (phase,))
    slow = unsupported_overhangs(part, RULE, phase)
    assert quick.area_mm2 == pytest.approx(slow.area_mm2, rel=5e-3, abs=0.02)
    assert quick.islands == slow.islands
