"""Drains of solids whose pools are known by hand; judged by the pour test, which is no part of it.

All at a diameter of 3.5 mm and a wall of 2 mm.
"""

from __future__ import annotations

import numpy as np
import pytest
from drain_measures import hole_diameter_mm
from manifold3d import Manifold
from solids import box, cylinder

from printprep.drainage.channel import bored
from printprep.drainage.drain_cavities import Drained, drain_cavities
from printprep.drainage.trapped import suction_cups, trapped
from printprep.profile_schema import DrainSettings as HoleCounts
from printprep.types import Drain

WALL = 2.0
DIAMETER = 3.5


def drain(outside: Manifold, *cavities: Manifold, count: int = 2) -> tuple[Manifold, Drained]:
    found = drain_cavities(
        outside,
        cavities,
        diameter_mm=DIAMETER,
        count_of=lambda volume_mm3: count,
        wall_mm=WALL,
        min_feature_mm=1.5,
    )
    part = outside
    for cavity in found.cavities:
        part -= cavity
    for hole in found.holes:
        part -= bored(hole.channel)
    return part, found


def described(found: Drained) -> list[Drain]:
    return [
        Drain(
            hole.role,
            hole.cavity,
            tuple(hole.channel.centre_mm),
            tuple(hole.channel.axis),
            hole.channel.diameter_mm,
            hole.channel.length_mm,
        )
        for hole in found.holes
    ]


def inner(x: float, y: float, z: float, low: float = WALL) -> Manifold:
    return box(x, y, z).translate((0, 0, low))


def table() -> tuple[Manifold, Manifold]:
    """A table on two feet 14 mm square and 20 mm apart, and the cavity 2 mm below its surface."""
    outside, cavity = box(48, 14, 14).translate((0, 0, 20)), inner(44, 10, 10, 22)
    for x in (-17, 17):
        outside += box(14, 14, 20).translate((x, 0, 0))
        cavity += inner(10, 10, 22, WALL).translate((x, 0, 0))
    return outside, cavity


def test_a_box_gets_an_outlet_at_its_floor_and_a_vent_at_its_top():
    part, found = drain(box(30, 30, 30), inner(26, 26, 26))
    assert [hole.role for hole in found.holes] == ["outlet", "vent"]
    outlet, vent = (hole.channel for hole in found.holes)
    assert outlet.floor_mm == pytest.approx(WALL, abs=0.05)
    assert outlet.axis[2] < 0 and outlet.low_mm > 0.9
    assert vent.inner_mm[2] > 20
    # Through the wall and no farther, and nothing left to trap
    assert outlet.length_mm == pytest.approx(WALL / max(abs(outlet.axis[:2])), rel=0.05)
    assert len(part.decompose()) == 1 and part.genus() == 1
    assert trapped(part, DIAMETER) == () and suction_cups(part) == ()


def test_what_is_sealed_is_found_trapped_and_sucking():
    part = box(30, 30, 30) - inner(26, 26, 26)
    assert trapped(part, DIAMETER) and suction_cups(part)


def test_a_flat_floor_falls_to_its_outlet():
    _, found = drain(box(60, 60, 20), inner(56, 56, 16))
    assert len(found.cavities) == 1
    # A hundredth of the way to the hole, over some 30 mm on the mean of 56²
    assert 0.1 * 56**2 < found.filled_mm3 < 0.6 * 56**2


def test_every_foot_of_a_table_gets_its_outlet():
    outside, cavity = table()
    part, found = drain(outside, cavity)
    outlets = [h.channel.inner_mm[0] for h in found.holes if h.role == "outlet"]
    assert sorted(np.sign(outlets)) == [-1, 1]
    assert sum(hole.role == "vent" for hole in found.holes) == 1
    assert trapped(part, DIAMETER) == () and suction_cups(part) == ()


def test_two_rooms_joined_by_a_gap_hardly_lower_than_the_hole_share_an_outlet():
    """Rooms of 0.7 cm³, the gap between them on their floor and 0.1 mm lower than the hole.

    Half of the gap is at the height of a layer of cells.
    """
    floor = 5.5 * DIAMETER / 5 - DIAMETER / 2 + 0.05
    cavity = inner(8, 4, DIAMETER - 0.1, floor)
    for x in (-9, 9):
        cavity += inner(10, 10, 7, floor).translate((x, 0, 0))
    part, found = drain(box(32, 14, 12), cavity)
    assert sum(hole.role == "outlet" for hole in found.holes) == 1
    assert found.filled_mm3 < 0.05 * cavity.volume()
    assert trapped(part, DIAMETER - 0.5) == () and suction_cups(part) == ()


def test_a_pit_too_small_for_a_hole_is_filled():
    pit = cylinder(3.0, 4.0).translate((0, 0, 4))
    cavity = inner(26, 26, 20, 8) + pit
    part, found = drain(box(30, 30, 30), cavity)
    assert sum(hole.role == "outlet" for hole in found.holes) == 1
    assert found.filled_mm3 > np.pi * 9 * 4
    assert trapped(part, DIAMETER) == () and suction_cups(part) == ()


def test_a_cavity_that_holds_no_ball_of_the_hole_is_filled_whole():
    thin = inner(26, 26, 2.4, 24)
    part, found = drain(box(30, 30, 30), inner(26, 26, 18), thin)
    assert len(found.cavities) == 1
    assert found.closed_mm3 == (pytest.approx(thin.volume()),)
    assert trapped(part, DIAMETER) == ()


def test_more_holes_where_more_are_asked_for():
    _, found = drain(box(40, 40, 40), inner(36, 36, 36), count=4)
    mouths = np.array([hole.channel.centre_mm for hole in found.holes])
    assert len(mouths) == 4
    apart = np.linalg.norm(mouths[:, None] - mouths, axis=2)[np.triu_indices(4, 1)]
    assert apart.min() > 2 * DIAMETER


@pytest.mark.parametrize(("side", "holes"), [(36, 2), (38, 3)])
def test_powder_gets_a_hole_for_every_so_much_that_a_cavity_holds(side, holes):
    """A cavity of 46.7 or 54.9 cm³ at a hole for every 25 cm³; the least count is 2."""
    counts = HoleCounts(diameter_mm=DIAMETER, count=2, cm3_per_hole=25.0)
    outside = box(side + 4, side + 4, side + 4)
    found = drain_cavities(
        outside,
        [inner(side, side, side)],
        diameter_mm=DIAMETER,
        count_of=counts.holes_of,
        wall_mm=WALL,
        min_feature_mm=1.5,
    )
    assert len(found.holes) == holes


def test_no_cavity_no_drain():
    assert drain(box(30, 30, 30))[1].holes == ()


@pytest.mark.parametrize("shape", ["box", "table"])
def test_holes_are_as_wide_as_asked_on_the_mesh(shape):
    outside, cavity = table() if shape == "table" else (box(30, 30, 30), inner(26, 26, 26))
    part, found = drain(outside, cavity)
    for described_drain in described(found):
        assert hole_diameter_mm(part, described_drain) == pytest.approx(DIAMETER, abs=0.05)


def test_a_mouth_never_opens_into_the_models_own_cup():
    """A box on a skirt: its underside is shut by the plate, so the outlet goes sideways."""
    outside = box(40, 40, 40) - box(34, 34, 8)
    part, found = drain(outside, inner(36, 36, 28, 10))
    outlet = found.holes[0].channel
    assert max(abs(outlet.centre_mm[:2])) == pytest.approx(20, abs=0.2)
    cups = suction_cups(part)  # the skirt's own, reported and left alone
    assert len(cups) == 1 and cups[0].from_mm < 1
