"""Local thickness against closed forms, within 2 % or 0.02 mm, and no thinness at convex edges."""

from __future__ import annotations

import math

import numpy as np
import pytest
from closed_form_parts import box
from manifold3d import CrossSection, Manifold

from printprep.mesh.measure import arrays
from printprep.thickness import gap_places, local_thickness, thin_places

SAMPLES = 3000


def measured(part: Manifold, **options: object):
    return local_thickness(*arrays(part), samples=SAMPLES, **options)


def close_to(value: np.ndarray, wanted: np.ndarray | float) -> np.ndarray:
    return np.abs(value - wanted) <= np.maximum(0.02, 0.02 * np.asarray(wanted))


def wedge(deg: float, length: float = 20.0, depth: float = 30.0) -> Manifold:
    """A wedge with its edge along y at the origin, symmetric about z = 0, opening along x."""
    half = length * math.tan(math.radians(deg / 2))
    outline = CrossSection([[(0.0, 0.0), (length, -half), (length, half)]])
    return outline.extrude(depth).rotate((90, 0, 0)).translate((0, depth / 2, 0))


def rhombus(deg: float) -> Manifold:
    """A prism with edges of this angle and of what is left to 180°."""
    rise = 30 * math.tan(math.radians(deg / 2))
    return CrossSection([[(-30, 0), (0, -rise), (30, 0), (0, rise)]]).extrude(30)


@pytest.mark.parametrize("thick", [0.05, 1.7, 6.0])
def test_a_plate_is_as_thick_as_it_is_up_to_its_rim(thick):
    found = measured(Manifold.cube((40, 30, thick)).rotate((20, 35, 50)))
    plate = np.isclose(np.abs(found.ball_mm - thick), 0, atol=0.02)
    rim = 2 * (40 + 30) * thick / (2 * (40 + 30) * thick + 2 * 40 * 30)
    assert plate.mean() == pytest.approx(1 - rim, abs=0.01)
    assert set(np.round(found.ball_mm[~plate])) <= {30, 40}
    assert np.allclose(found.ray_mm, found.ball_mm)


@pytest.mark.parametrize(("outer", "inner"), [(20, 18), (20, 19.5), (20, 10)])
def test_a_shell_of_a_sphere(outer, inner):
    shell = Manifold.sphere(outer, 128) - Manifold.sphere(inner, 128)
    found = measured(shell)
    assert close_to(found.ball_mm, outer - inner).all()
    assert close_to(found.ray_mm, outer - inner).mean() > 0.99


def test_a_ball_is_as_thick_as_its_diameter():
    found = measured(Manifold.sphere(10, 96))
    assert close_to(found.ball_mm, 20).all()


@pytest.mark.parametrize("deg", [10, 30, 50])
def test_a_wedge_is_thin_toward_its_edge(deg):
    found = measured(wedge(deg))
    sides = np.abs(found.normals[:, 0] - (-math.sin(math.radians(deg / 2)))) < 1e-6
    # Ball at distance s from the edge along a side: radius s tan(half the angle).
    along = np.hypot(found.points[:, 0], found.points[:, 2])
    ball = 2 * along * math.tan(math.radians(deg / 2))
    # Near the back and the ends the same ball would leave the wedge.
    inside = sides & (found.points[:, 0] < 12) & (np.abs(found.points[:, 1]) < 12)
    assert inside.sum() > 300
    assert close_to(found.ball_mm[inside], ball[inside]).all()


@pytest.mark.parametrize("deg", [20, 40])
def test_a_cone_is_thin_toward_its_tip(deg):
    height = 30.0
    base = height * math.tan(math.radians(deg / 2))
    cone = Manifold.cylinder(height, base, 0, 360)
    found = measured(cone)
    down = height - found.points[:, 2]
    slant = np.hypot(down, np.hypot(found.points[:, 0], found.points[:, 1]))
    ball = 2 * slant * math.tan(math.radians(deg / 2))
    side = (found.normals[:, 2] > 0) & (down > 1) & (down < 18)
    assert side.sum() > 300
    assert close_to(found.ball_mm[side], ball[side]).all()


@pytest.mark.parametrize(
    "part",
    [
        box(30),
        box(30).rotate((10, 20, 30)),
        Manifold.sphere(15, 200),
        Manifold.cylinder(30, 12, 12, 200),
        rhombus(61),
        Manifold.tetrahedron().scale((30, 30, 30)),
        box(30) - box(10, 40, z=-1),
    ],
    ids=["cube", "turned cube", "ball", "cylinder", "blunt edges", "tetrahedron", "square hole"],
)
def test_nothing_is_thin_at_edges_and_facets(part):
    assert measured(part, at_most_mm=5.0).ball_mm.min() == pytest.approx(5.0)


def test_a_bound_only_cuts_what_is_thicker():
    part = wedge(40) + box(6).translate((15, 0, -3))
    whole, bounded = measured(part), measured(part, at_most_mm=3.0)
    assert bounded.ball_mm == pytest.approx(np.minimum(whole.ball_mm, 3.0), rel=0.02)


class TestGaps:
    @pytest.mark.parametrize("gap", [0.15, 0.6, 2.0])
    def test_between_two_bodies(self, gap):
        part = box(20) + box(20).translate((20 + gap, 0, 0))
        found = measured(part, at_most_mm=5.0, gaps=True)
        near = found.ball_mm < 4.9
        assert near.mean() == pytest.approx(1 / 6, abs=0.02)
        assert close_to(found.ball_mm[near], gap).all()

    def test_inner_corners_are_none(self):
        part = box(30) - box(10, 40, z=-1) - Manifold.cube((40, 20, 20)).translate((-5, -5, 20))
        assert not (measured(part, at_most_mm=5.0, gaps=True).ball_mm < 4.99).any()

    def test_places_half_way_between(self):
        part = box(20) + box(20).translate((20.3, 0, 0))
        found = gap_places(part, 0.5)
        assert found.total_mm2 == pytest.approx(2 * 400, rel=0.03)
        assert found.middle[:, 0] == pytest.approx(np.full(len(found), 10.15), abs=1e-6)


class TestPlaces:
    def test_a_fin_is_wide_a_rod_is_not(self):
        block = box(20)
        fin = Manifold.cube((20, 0.8, 10)).translate((-10, -0.4, 20))
        rod = Manifold.cylinder(10, 0.4, 0.4, 48).translate((0, 0, 20))
        on_fin, on_rod = thin_places(block + fin, 1.2), thin_places(block + rod, 1.2)
        assert on_fin.total_mm2 == pytest.approx(2 * 20 * 10, rel=0.05)
        assert on_fin.thinnest[0] == pytest.approx(0.8, rel=0.01)
        assert (on_fin.wide_mm > 5).mean() > 0.9
        assert on_rod.total_mm2 == pytest.approx(math.pi * 0.8 * 10, rel=0.2)
        # At its end a ball touches the rim, and its middle lies beside the axis
        whole = on_rod.middle[:, 2] < 29.4
        assert whole.sum() > 0.9 * len(on_rod)
        assert on_rod.wide_mm[whole] == pytest.approx(np.full(whole.sum(), 0.8), rel=0.02)
        assert (on_rod.wide_mm < 0.82).all()

    def test_the_limit_from_both_sides(self):
        plate = Manifold.cube((20, 20, 1.2))
        assert len(thin_places(plate, 1.19)) == 0
        assert thin_places(plate, 1.21).total_mm2 == pytest.approx(800, rel=0.02)

    def test_a_solid_has_none(self):
        assert len(thin_places(box(20), 2.0)) == len(gap_places(box(20), 2.0)) == 0
