"""Dents and tips that layers hold shut: filled to the sill they empty over, and nothing besides."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold, OpType
from sl1_layers import shut_toward_plate
from solids import box

from printprep.drainage.channel import Channel, bored
from printprep.drainage.dexels import dexels_of, filled
from printprep.drainage.drain_cavities import drain_cavities
from printprep.drainage.pools import RAISED_MM
from printprep.drainage.residual_pools import FALL, FILM_MM, residual_pools
from printprep.types import Grid

PITCH = 0.35
RADIUS = 1.75
FLOOR = 2.0


def channel() -> Channel:
    """A level way out on the floor at x = 0, 8.4 mm to the side."""
    inner = np.array([0.0, -8.0, FLOOR + RADIUS])
    return Channel(inner, np.array([0.0, -1.0, 0.0]), 2 * RADIUS, 4.0, 5.0, 2.0, FLOOR)


def hollowable_volume() -> Manifold:
    """20 × 20 mm under a ceiling at 12 mm, its floor falling by 2 % toward −y, to 0.3 mm above the
    outlet's: as it is, all of it drains."""
    corners = [(x, y) for x in (-10, 10) for y in (-10, 10)]
    low = [(x, y, floor_at(y)) for x, y in corners]
    return Manifold.hull_points(np.array([*low, *((x, y, 12) for x, y in corners)], dtype=float))


def floor_at(y: float) -> float:
    return FLOOR + 0.3 + 0.02 * (y + 10)


def with_gutter(void: Manifold) -> Manifold:
    """And along its lowest side a gutter 4 mm wide, level, down to the outlet's floor."""
    return void + box(20, 4, 5).translate((0, -8, FLOOR))


def test_a_floor_that_falls_is_left_as_it_is():
    void = with_gutter(hollowable_volume())
    left = void - residual_pools(void, [channel()], PITCH)
    assert (hollowable_volume() - left).volume() < 1e-3
    # The gutter's own is raised to the outlet's level, and by the fall on top
    assert void.volume() - left.volume() < 80 * (RAISED_MM + FALL * 14)


def test_a_pit_is_filled_to_its_rim():
    pit = box(2.6, 3.0, 1.0).translate((5, 5, floor_at(3.5) - 1.0))
    void = with_gutter(hollowable_volume() + pit)
    left = void - residual_pools(void, [channel()], PITCH)
    assert (left ^ (pit - hollowable_volume())).volume() < 0.02 * pit.volume()
    # To the lowest of its rim and the fall on top, nothing besides
    assert (hollowable_volume() - left).volume() < 2.6 * 3.0 * 0.05


def test_a_tip_that_nothing_leaves_is_filled_whole():
    """A spike below the floor, wide enough for a few columns, its way out back up."""
    spike = Manifold.cylinder(2.2, 0.3, 1.5, 48).translate((-6, 3, FLOOR))
    void = with_gutter(hollowable_volume() + spike)
    left = void - residual_pools(void, [channel()], PITCH)
    assert (left ^ (spike - hollowable_volume())).volume() < PITCH**3


def test_a_dent_of_a_film_is_left():
    dent = hollowable_volume().translate((0, 0, -FILM_MM / 2)) ^ box(4, 4, 12).translate((4, 4, 0))
    void = with_gutter(hollowable_volume() + dent)
    left = void - residual_pools(void, [channel()], PITCH)
    assert (dent - left).volume() < 1e-3


@pytest.mark.parametrize(("high_mm", "left"), [(0.2, False), (0.8, True)])
def test_nothing_runs_through_a_crack(high_mm, left):
    """A slot into the room's far side, 3 mm deep, above its floor."""
    slot = box(6, 6, high_mm).translate((0, 10, 6.0))
    void = with_gutter(hollowable_volume() + slot)
    beyond = (slot - hollowable_volume()) ^ (void - residual_pools(void, [channel()], PITCH))
    share = beyond.volume() / (slot - hollowable_volume()).volume()
    # A high one is raised by the fall along its level floor, a low one stays open at its mouth
    assert share > 0.9 if left else share < 0.1


def test_nothing_of_nothing():
    assert residual_pools(Manifold(), [], PITCH).is_empty()
    assert (
        hollowable_volume() - residual_pools(hollowable_volume(), [], PITCH)
    ).volume() < 1e-6 * hollowable_volume().volume()


@pytest.mark.parametrize(("roll_deg", "tilt_deg"), [(30, 3), (45, 3)])
def test_a_trough_that_falls_to_its_outlet_holds_nothing_shut(roll_deg, tilt_deg):
    """A bar on its edge, one end lower: every layer of it is open to the layers below.

    What balls of two sizes leave is filled in steps along the edge; between them nothing may stay.
    """
    bar = Manifold.cube([40, 10, 10], True).rotate((roll_deg, 0, 0)).rotate((0, tilt_deg, 0))
    cavity = bar.translate((0, 0, 20))
    outside = box(60, 60, 40)
    found = drain_cavities(
        outside,
        [cavity],
        diameter_mm=2 * RADIUS,
        count_of=lambda volume_mm3: 2,
        wall_mm=2.0,
        min_feature_mm=1.5,
    )
    bores = [bored(hole.channel) for hole in found.holes]
    part = Manifold.batch_boolean([outside, *found.cavities, *bores], OpType.Subtract)
    pixel = 0.2
    grid = Grid(np.array([-31.0, -31.0, pixel / 2]), pixel, (311, 311, 200))
    empty = ~filled(dexels_of(part, grid), grid)
    shut = shut_toward_plate(empty.transpose(2, 0, 1))
    assert shut.sum() * pixel**3 < 0.1
    assert shut.sum(axis=(1, 2)).max() * pixel**2 < 0.7
    assert found.filled_mm3 < 70
