"""Suction cups by hand: what opens downward or sideways in time is none, what opens late is one."""

from __future__ import annotations

import pytest
from closed_form_parts import box, hollow_box
from manifold3d import Manifold

from printprep.drainage.trapped import suction_cups


def side_hole(z: float, diameter_mm: float = 3.0) -> Manifold:
    drill = Manifold.cylinder(10, diameter_mm / 2, diameter_mm / 2, 48)
    return drill.rotate((0, 90, 0)).translate((8, 0, z))


def test_a_solid_and_nothing_have_none():
    assert suction_cups(box(20)) == ()
    assert suction_cups(Manifold()) == ()


def test_a_mug_is_a_cup_up_to_its_rim():
    (cup,) = suction_cups(box(20) - box(16, 40, z=2))
    assert cup.opens
    assert (cup.from_mm, cup.to_mm) == pytest.approx((2, 20), abs=0.1)
    assert cup.area_mm2 == pytest.approx(256, rel=0.02)
    assert cup.volume_mm3 == pytest.approx(256 * 18, rel=0.02)
    assert cup.place_mm == pytest.approx((0, 0, 2), abs=0.3)


def test_a_sealed_cavity_never_opens():
    (cup,) = suction_cups(hollow_box(20, 2))
    assert not cup.opens
    assert (cup.from_mm, cup.to_mm) == pytest.approx((2, 18), abs=0.1)


def test_the_plate_shuts_a_bell():
    bell = box(20) - box(16, 18)
    (cup,) = suction_cups(bell)
    assert not cup.opens
    assert cup.from_mm == pytest.approx(0, abs=1e-6)
    vented = bell - side_hole(1.4)
    assert not suction_cups(vented)


@pytest.mark.parametrize(("z", "count"), [(3.6, 0), (6.0, 1), (12.0, 1)])
def test_a_cup_that_opens_late_is_a_cup_until_then(z, count):
    found = suction_cups(hollow_box(20, 2) - side_hole(z))
    assert len(found) == count
    for cup in found:
        assert cup.opens
        assert cup.to_mm == pytest.approx(z - 1.5, abs=0.2)
        assert cup.volume_mm3 == pytest.approx(256 * (z - 3.5), rel=0.05)


def test_a_raft_like_bottom_is_none():
    """Channels under a plate, open at its ends, and a grid of pillars."""
    plate = box(20)
    for y in (-6, -2, 2, 6):
        plate = plate - Manifold.cube((40, 2, 2)).translate((-20, y - 1, 0))
    assert not suction_cups(plate)


def test_a_cup_vented_through_a_neighbour_is_none():
    block = Manifold.cube((40, 20, 20)).translate((-20, -10, 0))
    rooms = box(16, 30, z=2).translate((-10, 0, 0)) + box(16, 30, z=2).translate((10, 0, 0))
    neck = Manifold.cube((10, 4, 4)).translate((-5, -2, 2))
    vent = Manifold.cube((10, 4, 4)).translate((15, -2, 2))
    assert not suction_cups(block - rooms - neck - vent)
    (cup,) = suction_cups(block - rooms - neck)
    assert cup.area_mm2 == pytest.approx(512, rel=0.05)
    assert len(suction_cups(block - rooms - vent)) == 1


@pytest.mark.parametrize(("side", "count"), [(3.4, 1), (2.9, 0)])
def test_narrow_cups_are_left_out(side, count):
    assert len(suction_cups(box(10) - box(side, 20, z=2))) == count
