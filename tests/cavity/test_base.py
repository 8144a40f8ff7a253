"""The base in closed form: a ball gets a drum, a flat foot nothing."""

from __future__ import annotations

import numpy as np
import pytest
import solids

from printprep.cavity.base import OVERLAP_MM, base_of, feet_of


def test_a_flat_foot_needs_no_seat() -> None:
    for flat in (solids.box(20, 20, 20), solids.cone(10, 20), solids.cylinder(9, 30)):
        assert base_of(feet_of(flat, 1.0, 0.2, 0.2), 0.0) is None


def test_a_ball_is_seated_on_a_drum() -> None:
    ball = solids.sphere(20, segments=512)
    base = base_of(feet_of(ball, 1.0, 0.2, 0.2), 0.0)
    assert base is not None
    radius = np.sqrt(2 * 20 * 1.0 - 1.0)
    area = base.manifold.slice(0.1).area()
    assert area == pytest.approx(np.pi * (radius + OVERLAP_MM) ** 2, rel=0.01)
    assert base.manifold.bounding_box()[2] == 0.0
    assert base.manifold.bounding_box()[5] == pytest.approx(1.0)
    # The drum less the cap of the ball below 1 mm is what the seat adds.
    cap = np.pi * 1.0**2 * (3 * 20 - 1.0) / 3
    added = (base.manifold - ball).volume()
    assert added == pytest.approx(np.pi * radius**2 - cap, rel=0.05)


def test_growth_widens_the_footprint_by_what_it_says() -> None:
    block = solids.box(20, 20, 20)
    base = base_of(feet_of(block, 1.0, 0.2, 0.2), 2.0)
    assert base is not None
    # A square grown by g with round corners: s² + 4 s g + π g².
    assert base.manifold.slice(0.5).area() == pytest.approx(400 + 160 + np.pi * 4, rel=2e-3)
    assert base.manifold.bounding_box()[5] == pytest.approx(1.0)


def test_the_seat_carries_only_what_is_within_its_height() -> None:
    # A table: a leg on the bed, a slab 0.6 mm above it and one 5 mm above it.
    leg = solids.box(4, 4, 10)
    low = solids.box(4, 4, 4).translate((10, 0, 0.6))
    bridge = solids.box(24, 4, 2).translate((0, 0, 5))
    table = leg + low + bridge
    base = base_of(feet_of(table, 1.0, 0.2, 0.2), 0.0)
    assert base is not None
    added = base.manifold - table
    assert added.volume() == pytest.approx((4 + 2 * OVERLAP_MM) ** 2 * 0.6, rel=0.03)
    assert added.bounding_box()[0] > 7.9


def test_voids_of_the_model_stay_open() -> None:
    void = solids.box(6, 6, 0.4).translate((0, 0, 0.3))
    block = solids.box(20, 20, 10) - void
    base = base_of(feet_of(block, 1.0, 0.2, 0.2), 1.0)
    assert base is not None
    assert (base.manifold ^ void).volume() == pytest.approx(0.0, abs=1e-9)
