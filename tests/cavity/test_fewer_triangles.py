"""Few triangles on a level set: the wall is kept, flats are exact, nothing folds."""

from __future__ import annotations

import numpy as np
import pytest
import solids
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.cavity.fewer_triangles import ACCEPTED_MM, measured
from printprep.cavity.surface import CHORD, cavity_surface, isosurface, lower_convex
from printprep.grid.depth import measure_depths
from printprep.grid.distance import DepthField
from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.gap import gap_mm
from printprep.mesh.measure import arrays
from printprep.mesh.self_intersections import self_intersections
from printprep.types import Grid


def both(manifold: Manifold, wall: float) -> tuple[Manifold, Manifold]:
    """The level set as marching cubes draws it, and the hollowable volume."""
    depths = measure_depths(solids.solid(manifold), resolution=48, wall_mm=wall, min_feature_mm=1.0)
    assert depths.field is not None
    return isosurface(depths.field, wall), cavity_surface(manifold, depths.field, wall)


def sound(outside: Manifold, cavity: Manifold, wall: float) -> None:
    assert gap_mm(outside, cavity, wall) >= wall - 0.045
    vertices, faces = arrays(cavity)
    assert len(self_intersections(vertices, faces).face) == 0
    assert measured(vertices, faces, SurfaceTree(*arrays(outside)), wall).worst_mm <= ACCEPTED_MM


def test_a_ball_keeps_its_volume_with_an_eighth_of_the_triangles() -> None:
    solid = solids.sphere(20)
    drawn, cavity = both(solid, 2.0)
    assert cavity.num_tri() <= drawn.num_tri() / 4
    sound(solid, cavity, 2.0)
    # Facets lie on the level set on average: the volume is that of the ball within 0.02 mm of wall
    assert cavity.volume() == pytest.approx(4 / 3 * np.pi * 18**3, rel=3 * 0.02 / 18)


def test_the_walls_of_a_box_are_exact_on_its_flats() -> None:
    solid = solids.box(40, 30, 20)
    _, cavity = both(solid, 1.5)
    sound(solid, cavity, 1.5)
    vertices, faces = arrays(cavity)
    walls = measured(vertices, faces, SurfaceTree(*arrays(solid)), 1.5)
    flat = walls.along > 0.999
    assert flat.mean() > 0.2  # the others are on edges, which the cells round off
    assert np.quantile(np.abs(walls.missing_mm[flat]), 0.9) < 0.002


@pytest.mark.slow
@examples(10)
@given(st.integers(0, 2**32 - 1))
def test_any_union_keeps_its_wall(seed: int) -> None:
    rng = np.random.default_rng(seed)
    solid = solids.box(18, 18, 14)
    for _ in range(int(rng.integers(1, 4))):
        piece = Manifold.sphere(float(rng.uniform(4, 9)), 32).translate(rng.uniform(-8, 8, 3))
        solid = solid - piece if rng.random() < 0.5 else solid + piece
    solid = max(solid.decompose(), key=lambda piece: piece.volume())
    depths = measure_depths(solids.solid(solid), resolution=48, wall_mm=1.2, min_feature_mm=1.0)
    cavity = cavity_surface(solid, depths.field, 1.2)
    if not cavity.is_empty():
        sound(solid, cavity, 1.2)


def test_a_convex_field_is_lowered_by_its_chords_and_a_flat_one_not() -> None:
    grid = Grid(np.zeros(3), 0.5, (21, 21, 21))
    x, y, _ = np.meshgrid(*(0.5 * np.arange(21),) * 3, indexing="ij")
    flat = DepthField(grid, x.astype(np.float32))
    lower_convex(flat, 5.0)
    assert np.allclose(flat.depth_mm, x, atol=1e-5)
    round_ = np.hypot(x, y).astype(np.float32)  # distance to an edge
    bent = DepthField(grid, round_.copy())
    lower_convex(bent, 5.0)
    near = (np.abs(round_ - 5.0) < 0.5) & (x > 0.5) & (y > 0.5) & (x < 9.5) & (y < 9.5)
    near[:, :, [0, -1]] = False
    # Second differences of a cylinder of radius r sum to pitch² / r
    assert np.allclose((round_ - bent.depth_mm)[near], CHORD * 0.25 / round_[near], rtol=0.05)


def test_cells_wider_than_the_wall_still_keep_it() -> None:
    """A model of a metre has such cells: there the drawn surface is far off, and drawn again."""
    groove = solids.box(6, 80, 20).rotate((20, 10, 30)).translate((0, 0, 25))
    block = solids.box(40, 40, 40) - groove
    depths = measure_depths(
        solids.solid(block), resolution=24, wall_mm=0.6, min_feature_mm=1.0, cells_per_wall=0.3
    )
    assert depths.field is not None and depths.field.grid.pitch_mm > 2 * 0.6
    cavity = cavity_surface(block, depths.field, 0.6)
    assert cavity.volume() > 0.8 * block.volume()
    sound(block, cavity, 0.6)
