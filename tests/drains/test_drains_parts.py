"""The parts of draining: open air, pools, what is filled, channels and plugs, by closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from manifold3d import Manifold
from solids import box

from printprep.drains.channel import Channel, bored
from printprep.drains.fill import filling
from printprep.drains.plugs import TAPER_MM, plug
from printprep.drains.pools import SLOPE, Outlet, Pools
from printprep.drains.space import dexels_of, open_air
from printprep.types import Drain, Grid


def test_open_air_knows_cups_by_their_layers():
    empty = np.ones((9, 9, 6), dtype=bool)
    empty[2:7, 2:7, 1:5] = False
    empty[4, 4, 2:5] = True  # a pit from above, shut until its top
    empty[4, 4, 0] = True
    found = open_air(empty)
    assert not found[4, 4, 2:5].any() and found[4, 4, 5] and found[0, 0].all()
    empty[4, 2:5, 2] = True  # a way out at its bottom
    assert open_air(empty)[4, 4, 2:5].all()


def w_shaped() -> tuple[Pools, Manifold]:
    """Two basins 10 × 10, floors at 1 and 3 mm, under one room, joined over a sill at 6 mm."""
    void = box(10, 10, 11).translate((-7.5, 0, 1)) + box(10, 10, 9).translate((7.5, 0, 3))
    void += box(25, 10, 6).translate((0, 0, 6))
    grid = Grid(np.array([-14.75, -7.25, 0.25]), 0.5, (60, 30, 28))
    return Pools(dexels_of(void, grid), grid), void


def outlet_at(pools: Pools, x: float, level: float) -> Outlet:
    i, _ = np.divmod(pools.dexels.column, pools.grid.shape[1])
    at = pools.grid.origin_mm[0] + pools.grid.pitch_mm * i
    return Outlet(np.flatnonzero(np.abs(at - x) < 0.3), level)


def test_without_an_outlet_all_of_it_stands():
    pools, void = w_shaped()
    standing = pools.standing_mm(pools.levels([]))
    held = float(standing.sum() * pools.area_mm2)
    assert held == pytest.approx(void.volume(), rel=0.02)


def test_a_basin_holds_up_to_its_sill():
    pools, _ = w_shaped()
    levels = pools.levels([outlet_at(pools, -12.2, 1.0)])
    pool, volume = pools.largest(pools.standing_mm(levels), np.zeros(0, dtype=np.int64))
    # 3 mm deep to the sill, and the slope from the outlet on top
    assert 300 < volume < 300 + 100 * 25 * SLOPE + 3
    assert pools.dexels.low_mm[pool].min() == pytest.approx(3.0)
    both = pools.levels([outlet_at(pools, -12.2, 1.0), outlet_at(pools, 12.2, 3.0)])
    assert float(pools.standing_mm(both).max()) < 25 * SLOPE


def test_an_outlet_above_the_floor_leaves_what_lies_below():
    pools, _ = w_shaped()
    levels = pools.levels([outlet_at(pools, -12.2, 2.0)])
    left = pools.dexels.low_mm < 1.5
    assert levels[left].min() == pytest.approx(2.0)
    assert levels[left].max() <= 2.0 + SLOPE * 10 * 1.1


def test_filling_takes_the_pool_and_leaves_the_rest():
    pools, void = w_shaped()
    levels = pools.levels([outlet_at(pools, -12.2, 1.0)])
    left = void - filling(pools, levels, _cells(pools))
    taken = void.volume() - left.volume()
    assert 300 < taken < 300 + 250 * 25 * SLOPE + 12
    # Nothing is left under the sill on the far side
    assert (left ^ box(9, 10, 5.9).translate((8, 0, 0))).volume() < 0.5


def _cells(pools: Pools) -> np.ndarray:
    from printprep.drains.space import _filled

    return _filled(pools.dexels, pools.grid)


def test_a_bore_is_a_cylinder_with_a_round_end():
    axis = np.array([0.6, 0.0, -0.8])
    channel = Channel(np.array([1.0, 2.0, 30.0]), axis, 4.0, 9.0, 10.0, 2.0, 0.0)
    expected = np.pi * 4 * 10 + 2 / 3 * np.pi * 8
    assert bored(channel).volume() == pytest.approx(expected, rel=5e-3)
    assert channel.centre_mm == pytest.approx([6.4, 2.0, 22.8])
    # A rod of the stated diameter goes through
    rod = Manifold.cylinder(10, 1.999, 1.999, 256)
    turned = rod.rotate((0, 0, 0))
    from printprep.drains.channel import frame

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
    tip = piece.slice(0.0 + 1e-6).area()
    assert tip == pytest.approx(np.pi * (1.75 - TAPER_MM / 2) ** 2, rel=0.01)
