"""A simplification that moves the surface is seen."""

from __future__ import annotations

import solids
from manifold3d import Manifold

from printprep.mesh.faithful import unfaithful


def test_the_same_surface_is_faithful_however_it_is_cut() -> None:
    block = solids.box(20, 20, 20)
    assert unfaithful(block, block, 1e-3) is None
    assert unfaithful(block.refine(4), block, 1e-3) is None
    assert unfaithful(block, block.refine(4), 1e-3) is None


def test_a_dent_is_seen_by_its_volume() -> None:
    block = solids.box(20, 20, 20)
    dent = block - solids.box(2, 2, 2).translate((0, 0, 18))
    assert "volume" in str(unfaithful(block, dent, 1e-3))


def test_what_moves_without_volume_is_seen_by_its_distance() -> None:
    block = solids.box(20, 20, 20)
    pin = solids.box(0.05, 0.05, 3).translate((0, 0, 19))
    assert "moves by" in str(unfaithful(block + pin, block, 1e-3))
    assert "moves by" in str(unfaithful(block, block + pin, 1e-3))


def test_rounding_a_ball_is_no_move() -> None:
    ball = Manifold.sphere(10.0, 64)
    assert unfaithful(ball, ball.simplify(1e-5), 1e-3) is None
