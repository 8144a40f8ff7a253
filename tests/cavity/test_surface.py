"""The cavity's surface and the part made from it: walls, volumes, topology."""

from __future__ import annotations

import math

import numpy as np
import pytest
import solids
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.cavity.carve import cavities_of, cut, make_part
from printprep.cavity.surface import cavity_surface
from printprep.cavity.ties import BESIDE_MM, tied
from printprep.grid.depth import measure_depths
from printprep.mesh.measure import arrays, distance_mm
from printprep.types import Plane


def hollowable_in(manifold: Manifold, wall: float, feature: float = 1.0) -> Manifold:
    depths = measure_depths(
        solids.solid(manifold), resolution=48, wall_mm=wall, min_feature_mm=feature
    )
    return cavity_surface(manifold, depths.field, wall)


def thinnest(outside: Manifold, cavity: Manifold) -> float:
    return min(
        distance_mm(arrays(cavity)[0], outside).min(), distance_mm(arrays(outside)[0], cavity).min()
    )


def test_the_hollowable_volume_of_a_cube_is_the_inner_cube() -> None:
    cube = solids.box(40, 40, 40)
    hollowable_volume = hollowable_in(cube, 2.0)
    assert 0.99 * 36**3 < hollowable_volume.volume() < 36**3 * 1.0005
    assert thinnest(cube, hollowable_volume) >= 2.0 - 0.04
    assert np.allclose(hollowable_volume.bounding_box(), [-18, -18, 2, 18, 18, 38], atol=0.03)


def test_the_hollowable_volume_of_a_ball_is_the_inner_ball() -> None:
    ball = solids.sphere(20)
    hollowable_volume = hollowable_in(ball, 2.0)
    assert hollowable_volume.volume() == pytest.approx(4 / 3 * np.pi * 18**3, rel=4e-3)
    assert thinnest(ball, hollowable_volume) >= 2.0 - 0.04


def test_reentrant_edges_keep_their_wall() -> None:
    # The groove's two edges point into the material: offset surfaces bulge toward chords there.
    block = solids.box(40, 40, 40) - solids.box(6, 60, 10).translate((0, 0, 30))
    hollowable_volume = hollowable_in(block, 1.2)
    assert 1.2 - 0.04 <= thinnest(block, hollowable_volume) <= 1.2 + 0.03


def test_a_void_that_stays_keeps_its_wall_and_is_tied_to_the_floor() -> None:
    void = solids.box(8, 8, 8).translate((0, 0, 16))
    cube = solids.box(40, 40, 40) - void
    hollowable_volume = tied(hollowable_in(cube, 2.0))
    assert thinnest(void, hollowable_volume) >= 2.0 - 0.04
    part = make_part(solids.solid(cube), None, cavities_of(hollowable_volume, 1.0))
    # The outside, the cavity and the void: the block around the void stands on the floor.
    assert len(part.manifold.decompose()) == 3
    assert len(part.cavities) == 1
    untied = hollowable_in(cube, 2.0)
    # The block's shadow, from the floor to its underside, and a rim around it up to its middle
    rim = 4 * 12 * BESIDE_MM + math.pi * BESIDE_MM**2
    tie = 12.0 * 12.0 * 12.0 + rim * (12.0 + 6.0)
    assert untied.volume() - hollowable_volume.volume() == pytest.approx(tie, rel=0.02)


def test_what_floats_in_a_cavity_is_left_out() -> None:
    cube = solids.box(40, 40, 40)
    room = solids.box(30, 30, 30).translate((0, 0, 5))
    floating = solids.box(8, 8, 8).translate((0, 0, 16))
    part = make_part(solids.solid(cube), None, cavities_of(room - floating, 1.0))
    assert part.manifold.volume() == pytest.approx(40**3 - 30**3, rel=1e-6)


@pytest.mark.slow
@examples(12)
@given(st.integers(0, 2**32 - 1))
def test_random_unions_keep_wall_and_manifold(seed: int) -> None:
    rng = np.random.default_rng(seed)
    solid = solids.box(20, 20, 12)
    for _ in range(int(rng.integers(1, 5))):
        piece = solids.box(*rng.uniform(5, 18, 3)).rotate(tuple(rng.uniform(0, 90, 3)))
        solid = solid + piece.translate((*rng.uniform(-8, 8, 2), float(rng.uniform(0, 10))))
    solid = max(solid.decompose(), key=lambda piece: piece.volume())
    hollowable_volume = hollowable_in(solid, 1.2)
    if hollowable_volume.is_empty():
        return
    assert thinnest(solid, hollowable_volume) >= 1.2 - 0.04
    part = make_part(solids.solid(solid), None, cavities_of(hollowable_volume, 1.0))
    removed = sum(cavity.volume() for cavity in part.cavities)
    assert part.manifold.volume() == pytest.approx(solid.volume() - removed, rel=1e-5)


def test_a_cut_keeps_what_lies_above_the_plane() -> None:
    hollowable_volume = solids.box(10, 10, 10)
    upper = cut(hollowable_volume, [hollowable_volume], [Plane((0.0, 0.0, 1.0), 4.0)])
    assert upper.volume() == pytest.approx(600)
    assert cut(hollowable_volume, [hollowable_volume], [None]).volume() == pytest.approx(1000)


def test_each_body_has_its_own_plane() -> None:
    left, right = solids.box(10, 10, 10), solids.box(10, 10, 10).translate((20, 0, 0))
    planes = [Plane((0.0, 0.0, 1.0), 4.0), None]
    assert cut(left + right, [left, right], planes).volume() == pytest.approx(1600)


@pytest.mark.parametrize(("size", "kept"), [(1.19, 0), (1.21, 1)])
def test_a_piece_is_kept_when_it_holds_the_smallest_ball(size: float, kept: int) -> None:
    assert len(cavities_of(solids.box(20, size, 20), 1.2)) == kept


def test_a_wide_and_low_piece_is_a_cavity() -> None:
    """Its height is less than half a step of the coarse lattice."""
    assert len(cavities_of(solids.box(120, 90, 4), 1.2)) == 1
    assert len(cavities_of(solids.box(120, 90, 1.19), 1.2)) == 0


def test_pieces_come_largest_first() -> None:
    pieces = solids.box(5, 5, 5) + solids.box(9, 9, 9).translate((20, 0, 0))
    volumes = [piece.volume() for piece in cavities_of(pieces, 1.0)]
    assert volumes == pytest.approx([729, 125])


def test_nothing_deep_enough_leaves_the_solid_as_it_is() -> None:
    plate = solids.box(40, 40, 2)
    hollowable_volume = hollowable_in(plate, 1.2)
    assert hollowable_volume.is_empty()
    part = make_part(solids.solid(plate), None, cavities_of(hollowable_volume, 1.2))
    assert part.cavities == ()
    assert part.manifold.volume() == pytest.approx(plate.volume())
