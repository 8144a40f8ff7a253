"""The parts of draining: open air, pools, what is filled, channels and plugs, by closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold
from solids import box

from printprep.drainage.balls import balls_in
from printprep.drainage.channel import Channel, bored, frame
from printprep.drainage.fill_undrained import filling
from printprep.drainage.hole_candidates import balls_at_rest
from printprep.drainage.plugs import TAPER_MM, plug
from printprep.drainage.pools import RAISED_MM, SLOPE, Pools
from printprep.drainage.voxelized_part import VoxelizedPart, open_air, voxelize, with_cavities
from printprep.grid.distance import Surface
from printprep.types import Drain


def test_open_air_knows_cups_by_their_layers():
    empty = np.ones((9, 9, 6), dtype=bool)
    empty[2:7, 2:7, 1:5] = False
    empty[4, 4, 2:5] = True  # a pit from above, shut until its top
    empty[4, 4, 0] = True
    found = open_air(empty)
    assert not found[4, 4, 2:5].any() and found[4, 4, 5] and found[0, 0].all()
    empty[4, 2:5, 2] = True  # a way out at its bottom
    assert open_air(empty)[4, 4, 2:5].all()


RADIUS = 1.75


def w_shaped() -> tuple[Pools, VoxelizedPart, Manifold]:
    """Two basins 10 × 10, floors at 1 and 3 mm, under one room, joined over a sill at 6 mm."""
    void = box(10, 10, 11).translate((-7.5, 0, 1)) + box(10, 10, 9).translate((7.5, 0, 3))
    void += box(25, 10, 6).translate((0, 0, 6))
    voxelized = with_cavities(voxelize(box(29, 14, 14), 2 * RADIUS), void)
    return Pools(balls_in(voxelized, Surface.of(void), RADIUS), voxelized.grid), voxelized, void


def channel_at(x: float, floor_mm: float) -> Channel:
    """A way out whose inner end's floor is at this height."""
    inner = np.array([x, 0.0, floor_mm + RADIUS])
    return Channel(inner, np.array([0.0, 1.0, 0.0]), 2 * RADIUS, 7.0, 7.5, 2.0, floor_mm)


LEFT, RIGHT = channel_at(-10.0, 1.0), channel_at(10.0, 3.0)


def test_a_ball_rests_a_radius_above_the_floor():
    pools, _, void = w_shaped()
    dexels = pools.dexels
    assert dexels.low_mm.min() == pytest.approx(1 + RADIUS, abs=0.02)
    assert dexels.high_mm.max() == pytest.approx(12 - RADIUS, abs=0.02)
    assert pools.volume_mm3.sum() == pytest.approx(void.volume(), rel=0.08)


def test_bands_of_balls_leave_none_out_and_none_twice():
    """Balls rest on a bowl's floor at every height; a band holds those between its ends."""
    void = Manifold.sphere(12, 96).translate((0, 0, 14))
    outside = Manifold.sphere(14, 96).translate((0, 0, 14))
    voxelized = with_cavities(voxelize(outside, 2 * RADIUS), void)
    pools = Pools(balls_in(voxelized, Surface.of(void), RADIUS), voxelized.grid)
    pool = np.arange(len(pools.dexels.column))
    lowest = pools.dexels.low_mm.min()
    low, high = (balls_at_rest(pools, pool, band)[:, 2] - lowest for band in ((0, 4), (4, 12)))
    assert low.max() <= 4 <= high.min() and high.max() <= 12
    assert low.min() < 0.1 and low.max() > 3.5 and high.min() < 4.5


def test_without_an_outlet_all_of_it_stays():
    pools, voxelized, void = w_shaped()
    assert np.isinf(pools.levels([])).all()
    left = void - filling(voxelized, pools.tops_mm([]))
    assert left.volume() < 1e-3 * void.volume()


def test_a_basin_holds_up_to_its_sill():
    pools, _, _ = w_shaped()
    levels = pools.levels(pools.outlets([LEFT]))
    pool, volume = pools.largest(pools.liquid_depth_mm(levels), np.zeros(0, dtype=np.int64))
    # 3 mm deep to the sill, all of it by where balls are; the slope from the outlet on top
    right = pool[pools.dexels.low_mm[pool] > 3]
    assert pools.dexels.low_mm[right].min() == pytest.approx(3 + RADIUS, abs=0.02)
    assert levels[right].max() == pytest.approx(6 + RADIUS + 12 * SLOPE, abs=0.2)
    assert 250 < volume < 600
    both = pools.levels(pools.outlets([LEFT, RIGHT]))
    assert float(pools.liquid_depth_mm(both).max()) < RAISED_MM + 25 * SLOPE


def test_an_outlet_above_the_floor_leaves_what_lies_below():
    pools, _, _ = w_shaped()
    levels = pools.levels(pools.outlets([channel_at(-10.0, 2.0)]))
    deep = pools.dexels.low_mm < 1.5 + RADIUS
    assert levels[deep].min() == pytest.approx(2 + RADIUS + RAISED_MM)
    assert levels[deep].max() <= 2 + RADIUS + RAISED_MM + SLOPE * 10 * 1.1


def test_filling_takes_the_pool_and_leaves_the_rest():
    pools, voxelized, void = w_shaped()
    left = void - filling(voxelized, pools.tops_mm([LEFT]))
    # Nothing is left under the sill on the far side; the near one keeps all but a sloping film
    assert (left ^ box(9, 10, 5.9).translate((8, 0, 0))).volume() < 0.5
    near = box(10, 10, 5).translate((-7.5, 0, 1))
    assert (near - left).volume() < 100 * (RAISED_MM + 10 * SLOPE)
    assert (left ^ box(40, 40, 4).translate((0, 0, 7))).volume() == pytest.approx(1000, abs=1)


def test_a_bore_is_a_cylinder_with_a_round_end():
    axis = np.array([0.6, 0.0, -0.8])
    channel = Channel(np.array([1.0, 2.0, 30.0]), axis, 4.0, 9.0, 10.0, 2.0, 0.0)
    expected = np.pi * 4 * 10 + 2 / 3 * np.pi * 8
    assert bored(channel).volume() == pytest.approx(expected, rel=5e-3)
    assert channel.centre_mm == pytest.approx([6.4, 2.0, 22.8])
    # A rod of the stated diameter goes through
    rod = Manifold.cylinder(10, 1.999, 1.999, 256)
    turned = rod.transform(np.column_stack([frame(axis), channel.inner_mm]))
    assert (turned - bored(channel)).volume() < 1e-6


def test_a_plug_fits_its_hole_and_ends_flush():
    outside = box(30, 30, 30)
    drain = Drain("outlet", 0, (15.0, 0.0, 6.0), (1.0, 0.0, 0.0), 3.5, 2.0)
    piece = plug(drain, outside)
    low, high = np.reshape(piece.bounding_box(), (2, 3))
    assert low[2] == pytest.approx(0.0, abs=1e-9)
    assert high[2] == pytest.approx(2.0, abs=1e-6)
    assert high[0] == pytest.approx(1.75, abs=0.01)
    tip = piece.slice(1e-6).area()
    assert tip == pytest.approx(np.pi * (1.75 - TAPER_MM / 2) ** 2, rel=0.01)
