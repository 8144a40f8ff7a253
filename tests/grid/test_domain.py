"""The voxel picture against closed forms: cube, sphere, and the depth of random points."""

from __future__ import annotations

import numpy as np
import pytest
import solids

from printprep.cavity.surface import cavity_surface
from printprep.grid.depth import _factors, measure_depths
from printprep.grid.distance import Surface, coarse_depth, refine
from printprep.grid.domain import Interior, weigh_interior
from printprep.grid.grid import block_around, grid_over, points_mm, subdivided
from printprep.types import Solid


def build_interior(
    solid: Solid, *, resolution: int, wall_mm: float, min_feature_mm: float
) -> Interior:
    depths = measure_depths(
        solid, resolution=resolution, wall_mm=wall_mm, min_feature_mm=min_feature_mm
    )
    return weigh_interior(solid, depths, cavity_surface(solid.manifold, depths.field, wall_mm))


def test_a_cube_is_a_whole_number_of_cells() -> None:
    grid = grid_over(np.array([-20.0, -20, 0]), np.array([20.0, 20, 40]), 64)
    assert grid.shape == (64, 64, 64)
    assert grid.pitch_mm == pytest.approx(40 / 64)
    first = points_mm(grid, np.array([0]))[0]
    np.testing.assert_allclose(first, [-20 + 40 / 128, -20 + 40 / 128, 40 / 128])


def test_sub_cells_fill_their_cell() -> None:
    grid = grid_over(np.zeros(3), np.array([4.0, 2.0, 1.0]), 4)
    fine = subdivided(grid, 3)
    centres = points_mm(fine, np.arange(np.prod(fine.shape))).reshape(4, 3, 2, 3, 1, 3, 3)
    means = centres.mean(axis=(1, 3, 5)).reshape(-1, 3)
    np.testing.assert_allclose(means, points_mm(grid, np.arange(8)), atol=1e-12)


def test_block_around_nothing_is_refused() -> None:
    with pytest.raises(ValueError, match="at least one True cell"):
        block_around(np.zeros((2, 2, 2), dtype=bool), 1)


@pytest.mark.parametrize(
    ("ratio", "factors"), [(0.5, ()), (1.0, ()), (1.5, (2,)), (3.9, (2, 2)), (5.5, (2, 3))]
)
def test_factors_reach_the_ratio_with_the_least_product(
    ratio: float, factors: tuple[int, ...]
) -> None:
    assert _factors(ratio) == factors


@pytest.mark.parametrize(
    "solid",
    [
        solids.box(30, 20, 40),
        solids.sphere(20),
        solids.box(40, 40, 40) - solids.sphere(8).translate((0, 0, 12)),
    ],
    ids=["box", "sphere", "box with a void"],
)
def test_the_fine_field_is_right_on_both_sides_of_the_wall(solid: object) -> None:
    wall = 1.5
    surface = Surface.of(solid)  # type: ignore[arg-type]
    box = np.array(solid.bounding_box())  # type: ignore[attr-defined]
    field = coarse_depth(surface, grid_over(box[:3], box[3:], 24))
    for factor in (2, 2):
        field = refine(surface, field, factor, wall)
    index = np.random.default_rng(0).integers(0, field.depth_mm.size, 20000)
    exact = surface.depth_mm(points_mm(field.grid, index))
    drawn = field.depth_mm.flat[index]
    np.testing.assert_array_equal(drawn > wall, exact.astype(np.float32) > np.float32(wall))
    near = np.abs(exact - wall) < field.grid.pitch_mm
    np.testing.assert_allclose(drawn[near], exact[near], atol=1e-5)


def test_the_interior_of_a_cube_weighs_what_the_inner_cube_does() -> None:
    interior = build_interior(
        solids.solid(solids.box(40, 40, 40)), resolution=32, wall_mm=2.0, min_feature_mm=1.0
    )
    volume, *moments = interior.moments.sum(axis=1)
    # The room is short by a fraction of a fine cell along its twelve edges.
    assert 0.99 * 36**3 < volume < 36**3 * 1.001
    np.testing.assert_allclose(np.array(moments) / volume, [0, 0, 20], atol=0.02)


@pytest.mark.slow
def test_the_interior_of_a_sphere_weighs_what_the_inner_ball_does() -> None:
    interior = build_interior(
        solids.solid(solids.sphere(20)), resolution=64, wall_mm=2.0, min_feature_mm=1.0
    )
    assert interior.moments[0].sum() == pytest.approx(4 / 3 * np.pi * 18**3, rel=4e-3)


def test_domain_arrays_partition_the_solid() -> None:
    interior = build_interior(
        solids.solid(solids.sphere(20)), resolution=32, wall_mm=2.0, min_feature_mm=1.0
    )
    domain = interior.domain
    assert not (domain.shell & domain.interior).any()
    assert (domain.free == domain.interior).all()
    assert ((domain.shell | domain.interior) == (domain.body >= 0)).all()
    assert interior.moments.shape == (4, int(domain.free.sum()))


@pytest.mark.parametrize(("thickness", "hollow"), [(3.55, False), (3.65, True)])
def test_a_gap_below_the_minimum_feature_is_left_solid(thickness: float, hollow: bool) -> None:
    # Walls of 1.2 mm leave 1.15 and 1.25 mm of room: on either side of a feature of 1.2 mm.
    plate = solids.box(40, 30, thickness)
    depths = measure_depths(solids.solid(plate), resolution=64, wall_mm=1.2, min_feature_mm=1.2)
    assert (depths.field is not None) is hollow


def test_bodies_are_told_apart() -> None:
    two = solids.box(10, 10, 10) + solids.box(10, 10, 10).translate((20, 0, 0))
    domain = build_interior(
        solids.solid(two), resolution=48, wall_mm=1.0, min_feature_mm=1.0
    ).domain
    bodies = domain.body[domain.free]
    assert set(bodies.tolist()) == {0, 1}
    left = points_mm(domain.grid, np.flatnonzero(domain.free))[:, 0] < 10
    assert len(set(bodies[left].tolist())) == 1
