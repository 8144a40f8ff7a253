"""The pour test on vessels whose contents are known by hand, on both sides of the ball's width."""

from __future__ import annotations

import numpy as np
import pytest
from closed_form_parts import box, hollow_box
from manifold3d import Manifold

from printprep.drainage.trapped import trapped

BALL_MM = 3.5
ROUND = 64


def hole(diameter_mm: float, length_mm: float = 6.0) -> Manifold:
    """A drill along z, its middle at the origin."""
    return Manifold.cylinder(length_mm, diameter_mm / 2, diameter_mm / 2, ROUND, center=True)


def tube(diameter_mm: float, x0: float, x1: float, z: float) -> Manifold:
    """A drill along x."""
    drill = Manifold.cylinder(x1 - x0, diameter_mm / 2, diameter_mm / 2, ROUND)
    return drill.rotate((0, 90, 0)).translate((x0, 0, z))


def two_rooms(neck_mm: float, drain_mm: float, *, neck_z: float, drain_z: float) -> Manifold:
    """A block with two rooms of 16 mm, floors at z = 2, a neck between, a drain from the right."""
    block = Manifold.cube((40, 20, 20)).translate((-20, -10, 0))
    rooms = box(16, z=2).translate((-10, 0, 0)) + box(16, z=2).translate((10, 0, 0))
    for diameter, x0, x1, z in ((neck_mm, -5, 5, neck_z), (drain_mm, 12, 25, drain_z)):
        if diameter:
            rooms = rooms + tube(diameter, x0, x1, z)
    return block - rooms


def test_a_solid_holds_nothing():
    assert trapped(box(20), BALL_MM) == ()


def test_nothing_holds_nothing():
    assert trapped(Manifold(), BALL_MM) == ()


def test_a_sealed_cavity_holds_its_volume():
    (pocket,) = trapped(hollow_box(30, 2), BALL_MM)
    assert pocket.kind == "sealed"
    assert pocket.volume_mm3 == pytest.approx(26**3, rel=0.05)
    assert pocket.place_mm[2] == pytest.approx(2, abs=0.6)
    assert pocket.depth_mm == pytest.approx(26, abs=0.6)


@pytest.mark.parametrize("at", [(0, 0), (3.123, -2.345), (-4.9, 4.7)])
@pytest.mark.parametrize("tilt", [0, 33])
@pytest.mark.parametrize(("diameter", "count"), [(BALL_MM, 0), (BALL_MM - 0.1, 1), (2.0, 1)])
def test_a_hole_in_the_floor_at_the_limit(at, tilt, diameter, count):
    drill = hole(diameter, 9.0).rotate((tilt, 0, 20)).translate((*at, 1.0))
    found = trapped(hollow_box(20, 2) - drill, BALL_MM)
    assert [pocket.kind for pocket in found] == ["narrow"] * count


def test_a_hole_in_the_ceiling_leaves_a_pool_in_a_cavity():
    (pocket,) = trapped(hollow_box(30, 2) - hole(4).translate((0, 0, 29)), BALL_MM)
    assert (pocket.kind, pocket.enclosed) == ("pool", True)
    assert pocket.volume_mm3 == pytest.approx(26**3, rel=0.05)


@pytest.mark.parametrize(("z", "depth"), [(4.0, 0.0), (9.0, 5.0), (20.0, 16.0)])
def test_a_hole_in_the_side_leaves_a_pool_up_to_its_lowest_point(z, depth):
    found = trapped(hollow_box(30, 2) - tube(4, 10, 20, z), BALL_MM)
    assert [pocket.kind for pocket in found] == (["pool"] if depth else [])
    for pocket in found:
        assert pocket.depth_mm == pytest.approx(depth, abs=0.7)
        assert pocket.volume_mm3 == pytest.approx(depth * 26**2, rel=0.1)


def test_a_mug_is_open_a_bottle_is_not():
    (mug,) = trapped(box(30) - box(26, 60, z=2), BALL_MM)
    (bottle,) = trapped(box(30) - box(26, 26, z=2) - hole(6).translate((0, 0, 29)), BALL_MM)
    assert (mug.kind, mug.enclosed) == ("pool", False)
    assert (bottle.kind, bottle.enclosed) == ("pool", True)
    assert mug.volume_mm3 == pytest.approx(28 * 26**2, rel=0.05)


class TestThroughANeighbour:
    def test_drains_through_a_neck_as_wide_as_the_ball(self):
        assert not trapped(two_rooms(3.5, 4, neck_z=3.8, drain_z=4), BALL_MM)

    def test_stays_behind_a_narrower_one(self):
        (pocket,) = trapped(two_rooms(3.3, 4, neck_z=3.7, drain_z=4), BALL_MM)
        assert pocket.kind == "narrow"
        assert pocket.volume_mm3 == pytest.approx(16**3, rel=0.05)
        assert pocket.place_mm[0] < 0

    def test_both_stay_behind_a_narrow_drain(self):
        (pocket,) = trapped(two_rooms(4, 3, neck_z=4, drain_z=4), BALL_MM)
        assert pocket.volume_mm3 == pytest.approx(2 * 16**3, rel=0.05)

    def test_a_room_without_a_neck_is_sealed(self):
        (pocket,) = trapped(two_rooms(0, 4, neck_z=4, drain_z=4), BALL_MM)
        assert pocket.kind == "sealed"
        assert pocket.place_mm[0] < 0

    def test_a_high_neck_keeps_a_pool(self):
        (pocket,) = trapped(two_rooms(4, 4, neck_z=10, drain_z=4), BALL_MM)
        assert pocket.kind == "pool"
        assert pocket.volume_mm3 == pytest.approx(6 * 16**2, rel=0.1)

    def test_which_cavity_is_told(self):
        rooms = [box(16, z=2).translate((x, 0, 0)) for x in (-10, 10)]
        for order in (rooms, rooms[::-1]):
            part = two_rooms(0, 4, neck_z=4, drain_z=4)
            (pocket,) = trapped(part, BALL_MM, cavities=order)
            assert pocket.cavity == (0 if order is rooms else 1)


def test_a_slot_too_thin_for_the_ball_is_judged_by_what_fits_in_it():
    slot, block = box(26, 2.8, z=10), box(30)
    (pocket,) = trapped(block - slot - hole(1.2, 30), BALL_MM)
    assert pocket.kind == "narrow"
    assert pocket.volume_mm3 == pytest.approx(2.8 * 26**2, rel=0.1)
    assert not trapped(block - slot - hole(4, 30), BALL_MM)
    assert not trapped(block - slot.translate((5, 0, 0)), BALL_MM)  # open along a side


@pytest.mark.parametrize("diameter", [1.0, 2.0, 2.7, 3.3])
@pytest.mark.parametrize("tilt", [0, 25])
def test_the_widest_way_out_is_measured(diameter, tilt):
    drill = hole(diameter, 9.0).rotate((tilt, 0, 20)).translate((2.2, 1.3, 1.0))
    smaller = hole(0.8, 9.0).translate((-5, 0, 0))
    (pocket,) = trapped(hollow_box(20, 2) - drill - smaller, BALL_MM)
    assert pocket.way_out_mm == pytest.approx(diameter, abs=0.08)


def test_small_pockets_are_left_out():
    part = hollow_box(5, 1)  # 27 mm³
    assert len(trapped(part, BALL_MM)) == 1
    assert not trapped(part, BALL_MM, least_mm3=40)


def test_what_is_trapped_does_not_depend_on_where_the_part_stands():
    part = hollow_box(20, 2).rotate((20, 30, 0))
    here = trapped(part, BALL_MM)
    there = trapped(part.translate((101.7, -33.3, 12.9)), BALL_MM)
    assert np.allclose([p.volume_mm3 for p in here], [p.volume_mm3 for p in there], rtol=0.02)
    assert here[0].volume_mm3 == pytest.approx(16**3, rel=0.05)
