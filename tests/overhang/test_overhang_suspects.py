"""Suspects: none on what always passes, and with them the rule flags what it flags without."""

from __future__ import annotations

import math

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold
from solids import box

from printprep.overhang.limits import slicer_acceptance
from printprep.overhang.rule import unsupported_ceilings, unsupported_overhangs
from printprep.overhang.suspects import SLACK_MM, Suspects
from printprep.profiles import load_profile

RULE = slicer_acceptance(load_profile("fdm-pla-0.4"))


def hanging(corners: list[tuple[float, float, float]], size: float = 20.0) -> Manifold:
    """A room with a piece that hangs from its ceiling, steep-sided but for its lower end."""
    room = box(size, size, 20).translate((0, 0, 1))
    return room - Manifold.hull_points(np.array(corners))


def keel(rise: float) -> Manifold:
    """It hangs down in an edge that climbs by ``rise`` over 10 mm, to a ceiling at 21 mm."""
    ridge = [(-5.0, 0.0, 8.0), (5.0, 0.0, 8.0 + rise)]
    roots = [(x, y, 22.0) for x in (-5.0, 5.0) for y in (-3.0, 3.0)]
    return hanging([*ridge, *roots])


def roof(tan: float, sides: int, across: float = 10.0) -> Manifold:
    """A room that closes upward in a pyramid on a regular polygon, all sides of one slope."""
    apothem = across / 2
    turn = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    corners = apothem / math.cos(math.pi / sides) * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    floor = np.column_stack([corners, np.ones(sides)])
    return Manifold.hull_points(np.vstack([floor, [0.0, 0.0, 1.0 + apothem / tan]]))


def shed(tan: float) -> Manifold:
    """A room under one slope that ends in a wall."""
    corners = [(x, y, 1.0) for x in (-5.0, 5.0) for y in (-5.0, 5.0)]
    return Manifold.hull_points(np.array([*corners, (-5, -5, 1 + 10 / tan), (-5, 5, 1 + 10 / tan)]))


STEEPEST = (RULE.off_mm - SLACK_MM) / RULE.layer_mm


@pytest.mark.parametrize(("tan", "many"), [(STEEPEST - 1e-3, 0), (STEEPEST + 1e-3, 2)])
def test_one_slope_may_reach_as_far_as_off(tan, many):
    """Both its triangles count, from the limit on."""
    assert len(Suspects.of(shed(tan), RULE)) == many


@pytest.mark.parametrize(("past", "many"), [(-1e-3, 0), (1e-3, 1)])
def test_slopes_that_face_each_other_close_in_a_corner(past, many):
    """The apex alone: along the hips walls meet at a right angle, and close less."""
    limit = (RULE.off_mm - RULE.closing_mm) / RULE.layer_mm
    boxes = Suspects.of(roof(limit + past, 4), RULE)
    assert len(boxes) == many
    if many:
        apex = 1 + 5 / (limit + past)
        depth = RULE.closing_mm / limit
        assert boxes.low_mm[0] == pytest.approx((0, 0, apex - depth))
        assert boxes.high_mm[0] == pytest.approx((0, 0, apex))


@pytest.mark.parametrize(("past", "many"), [(-1e-3, 1), (1e-3, 4)])
def test_walls_at_a_right_angle_close_from_a_steeper_slope_on(past, many):
    """h 2 s > 2 off − 4/3 c: then each hip is a groove, up to the apex."""
    tan = (RULE.off_mm - RULE.closing_mm * 2 / 3) / RULE.layer_mm + past
    boxes = Suspects.of(roof(tan, 4), RULE)
    assert np.isclose(boxes.high_mm[:, 2], 1 + 5 / tan).sum() == many


def test_a_level_keel_between_steep_faces_is_found():
    boxes = Suspects.of(keel(0.0), RULE)
    below = boxes.high_mm[:, 2] < 9
    assert below.any()
    assert boxes.low_mm[below].min(axis=0) == pytest.approx((-5, 0, 8))
    assert boxes.high_mm[below].max(axis=0) == pytest.approx((5, 0, 8))


def test_of_a_steep_keel_only_the_tip_is_found():
    steep = 10.0 / STEEPEST + 1e-6
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


@examples(15)
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


@examples(40)
@given(
    st.lists(
        st.tuples(st.floats(0, 360), st.floats(0.5, 0.93), st.floats(0, 3)), min_size=3, max_size=7
    ),
    st.floats(0, 0.95),
)
def test_steep_roofs_are_flagged_the_same_as_word_by_word(planes, phase):
    """Random slopes on either side of every limit, meeting in grooves at every angle."""
    void = box(12, 12, 25).translate((0, 0, 1))
    for turn, tan, away in planes:
        u = np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn)), tan])
        void = void.trim_by_plane((-u / np.linalg.norm(u)).tolist(), -away - 8 * tan)
    part = box(20, 20, 40) - void
    quick = unsupported_ceilings(void, RULE, (phase,))
    slow = unsupported_overhangs(part, RULE, phase)
    assert quick.area_mm2 == pytest.approx(slow.area_mm2, rel=5e-3, abs=2e-3)
    assert quick.islands == slow.islands
