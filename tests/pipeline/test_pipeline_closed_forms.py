"""The whole method on solids whose answer is known: wall, mass, centre of mass, tilt, plane."""

from __future__ import annotations

import numpy as np
import pytest
import solids
import trimesh
from manifold3d import Manifold
from scipy.optimize import brentq

from printprep.errors import UsageError
from printprep.mesh.measure import arrays, mass_properties
from printprep.pipeline.hollow import hollow
from printprep.result import HollowResult
from printprep.types import Advice

WALL = 1.2
GRAMS = 1.24 / 1000
SLOW = pytest.mark.slow


def hollowed(manifold: Manifold, **options: object) -> HollowResult:
    mesh = trimesh.Trimesh(*arrays(manifold), process=False)
    return hollow(mesh, **{"resolution": 48, "vaults": "none", **options})  # type: ignore[arg-type]


def test_a_cube_becomes_a_box_with_even_walls() -> None:
    result = hollowed(solids.box(40, 40, 40))
    exact = (40**3 - (40 - 2 * WALL) ** 3) * GRAMS
    # Edges and corners of the cavity are rounded off by at most a cell: never lighter, a bit more.
    assert exact * 0.998 <= result.mass_g <= exact * 1.02
    assert result.solid_mass_g == pytest.approx(64000 * GRAMS)
    assert result.part.base is None
    assert WALL - 0.05 <= result.wall_min_mm <= WALL + 0.01  # type: ignore[operator]
    np.testing.assert_allclose(result.stability.centre_of_mass_mm, [0, 0, 20], atol=0.01)
    assert result.stability.tilt_deg == pytest.approx(45, abs=0.05)
    assert len(result.part.cavities) == 1


def test_a_cylinder() -> None:
    result = hollowed(solids.cylinder(15, 60))
    shell = np.pi * (15**2 * 60 - (15 - WALL) ** 2 * (60 - 2 * WALL)) * GRAMS
    assert shell * 0.99 <= result.mass_g <= shell * 1.02
    assert result.stability.tilt_deg == pytest.approx(np.degrees(np.arctan(15 / 30)), abs=0.1)
    assert result.wall_min_mm >= WALL - 0.05  # type: ignore[operator]


def test_a_cone() -> None:
    radius, height = 20.0, 50.0
    result = hollowed(solids.cone(radius, height))
    # Inside is the similar cone whose faces lie a wall deeper: its inradius shrinks by the wall.
    slant = np.hypot(radius, height)
    scale = 1 - WALL * (slant + radius) / (radius * height)
    inner = np.pi * radius**2 * height / 3 * scale**3
    exact = (np.pi * radius**2 * height / 3 - inner) * GRAMS
    assert exact * 0.99 <= result.mass_g <= exact * 1.03
    # Centre of mass of the difference: the inner cone's foot is on z = wall.
    whole = np.pi * radius**2 * height / 3
    centre = (whole * height / 4 - inner * (WALL + height * scale / 4)) / (whole - inner)
    assert result.stability.centre_of_mass_mm[2] == pytest.approx(centre, abs=0.15)


@pytest.mark.parametrize("segments", [48, pytest.param(256, marks=SLOW)])
def test_a_ball_gets_a_seat_and_stands(segments: int) -> None:
    result = hollowed(solids.sphere(20, segments))
    base = result.part.base
    assert base is not None
    shell = 4 / 3 * np.pi * (20**3 - (20 - WALL) ** 3) * GRAMS
    assert result.mass_g >= shell * 0.99
    assert result.stability.tilt_deg >= 10  # type: ignore[operator]
    assert result.density.certificate is not None
    assert result.density.certificate.gap <= 1e-6


def prism_optimum(prism: Manifold, lean_deg: float) -> tuple[float, float]:
    """Least volume, and the plane's offset, of a prism leaning to +x, by exact trims alone.

    One edge binds: the right one, x = d.  Its plane has the normal (1, 0, tan α), and the offset
    is where the part's centre of mass lies exactly on the limit.
    """
    tangent = np.tan(np.radians(lean_deg))
    section = np.concatenate(prism.slice(0.1).to_polygons())
    edge = section[:, 0].max()
    # The void of the whole prism: walls measured across its slanted faces.
    inner = solids.leaning_prism(20, 60, 20)
    slope = np.hypot(1, 20 / 60)
    box = solids.box(20 - 2 * WALL * slope, 20 - 2 * WALL, 60 - 2 * WALL)
    shear = np.array([[1, 0, 20 / 60, 0], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=float)
    void = box.translate((0, 0, WALL)).transform(shear)
    assert (void - inner).volume() == pytest.approx(0, abs=1e-6)
    solid = mass_properties(prism)

    def ahead(offset: float) -> float:
        cut = void.trim_by_plane((1.0, 0.0, tangent), offset / np.hypot(1, tangent))
        volume, moment = solid.volume_mm3, np.array(solid.centre_mm) * solid.volume_mm3
        if not cut.is_empty():
            hole = mass_properties(cut)
            volume = volume - hole.volume_mm3
            moment = moment - np.array(hole.centre_mm) * hole.volume_mm3
        return float(edge * volume - moment[0] - tangent * moment[2])

    assert ahead(-25.0) < 0 < max(map(ahead, np.linspace(-25, 20, 50)))
    offset = brentq(ahead, -25, max(np.linspace(-25, 20, 50), key=ahead), xtol=1e-9)
    cut = void.trim_by_plane((1.0, 0.0, tangent), offset / np.hypot(1, tangent))
    return solid.volume_mm3 - cut.volume(), offset / np.hypot(1, tangent)


def test_a_leaning_prism_is_filled_up_to_the_exact_plane() -> None:
    prism = solids.leaning_prism(20, 60, 20)
    # The program works in the placed frame: the bounding box centred on x = 0.
    shift = -10.0
    result = hollowed(prism, base="never", lean=4.0, overrides={"stability.lean_margin_deg": 0.0})
    volume, offset = prism_optimum(prism, 4.0)
    plane = result.density.planes[0]
    assert plane is not None
    tangent = np.tan(np.radians(result.density.aim_deg))  # type: ignore[arg-type]
    np.testing.assert_allclose(
        plane.normal, np.array([1, 0, tangent]) / np.hypot(1, tangent), atol=1e-6
    )
    assert plane.offset_mm == pytest.approx(offset + shift * plane.normal[0], abs=0.5)
    assert result.mass_g == pytest.approx(volume * GRAMS, rel=0.02)
    assert 4.0 <= result.stability.tilt_deg <= 4.3  # type: ignore[operator]
    certificate = result.density.certificate
    assert certificate is not None and certificate.gap <= 1e-6
    assert certificate.voxel_mass_g == pytest.approx(result.mass_g, rel=5e-3)


def test_a_thin_plate_is_written_solid_with_a_finding() -> None:
    result = hollowed(solids.box(40, 40, 2))
    assert result.part.cavities == ()
    assert result.wall_min_mm is None
    assert result.mass_g == pytest.approx(result.solid_mass_g, rel=1e-6)
    assert "nothing-to-hollow" in {finding.rule for finding in result.findings}


def test_two_bodies_each_stand_by_themselves() -> None:
    pair = solids.leaning_prism(20, 60, 20) + solids.box(20, 20, 20).translate((60, 0, 0))
    result = hollowed(pair, base="never", lean=4.0)
    planes = result.density.planes
    assert len(planes) == 2
    assert sum(plane is None for plane in planes) == 1
    assert result.stability.tilt_deg >= 4.0  # type: ignore[operator]


@SLOW
def test_the_same_model_gives_the_same_part() -> None:
    first, second = (hollowed(solids.leaning_prism(20, 60, 20)) for _ in range(2))
    for a, b in zip(arrays(first.part.manifold), arrays(second.part.manifold), strict=True):
        np.testing.assert_array_equal(a, b)


def test_the_paper_objective_fills_below_a_plane() -> None:
    result = hollowed(solids.leaning_prism(20, 60, 12), objective="paper", resolution=32)
    assert result.density.certificate is None
    assert result.mass_g < result.solid_mass_g
    assert result.wall_min_mm is None or result.wall_min_mm >= WALL - 0.05


@SLOW
def test_a_lean_toward_the_safe_side_needs_no_ballast() -> None:
    # It leans to +x; toward −x it has plenty of room, and only has to stand upright besides.
    prism = solids.leaning_prism(20, 60, 16)
    every = hollowed(prism, base="never", lean=5.0)
    back = hollowed(prism, base="never", lean="5@180")
    ahead = hollowed(prism, base="never", lean="5@0")
    assert back.mass_g < every.mass_g
    assert back.density.planes == (None,)
    assert ahead.mass_g == pytest.approx(every.mass_g, rel=1e-3)


def test_a_lean_toward_a_corner_is_kinder_than_toward_a_side() -> None:
    box = solids.box(10, 10, 100)
    # atan(5 / 50) = 5.7° toward a side, atan(5 √2 / 50) = 8.05° toward a corner.
    assert hollowed(box, base="never", lean="8@45").density.reachable_deg is None
    assert hollowed(box, base="never", lean=8.0).stability.tilt_deg < 45.0  # type: ignore[operator]


@pytest.mark.parametrize("lean", ["ten", "10@", "@90", "61", "-1", "nan"])
def test_a_lean_that_cannot_be_meant_is_refused(lean: str) -> None:
    with pytest.raises(UsageError, match="lean"):
        hollowed(solids.box(10, 10, 10), lean=lean)


# A post of 10 × 10 × 120 mm: full or empty its centre is at 60 at best a bit lower
out_of_reach = pytest.mark.xdist_group("lean out of reach")


def post_grown(most_mm: float, lean: float, resolution: int) -> HollowResult:
    overrides = {"stability.base_growth_max_mm": most_mm}
    post = solids.box(10, 10, 120)
    return hollowed(post, lean=lean, resolution=resolution, overrides=overrides)


@pytest.fixture(scope="module", params=[(9.0, 24), pytest.param((30.0, 48), marks=SLOW)])
def asked(request: pytest.FixtureRequest) -> tuple[float, int]:
    """A lean in degrees that the post does not reach on a foot 1 mm wider, and a resolution."""
    return request.param


@pytest.fixture(scope="module")
def advice(asked: tuple[float, int]) -> Advice:
    found = post_grown(1.0, *asked)
    assert found.density.reachable_deg is not None
    assert found.advice is not None and found.advice.growth_mm is not None
    return found.advice


@out_of_reach
def test_the_growth_that_is_named_reaches_the_lean(
    advice: Advice, asked: tuple[float, int]
) -> None:
    assert post_grown(advice.growth_mm, *asked).density.reachable_deg is None


@out_of_reach
def test_half_a_millimetre_less_than_is_named_does_not_reach_it(
    advice: Advice, asked: tuple[float, int]
) -> None:
    assert post_grown(advice.growth_mm - 0.5, *asked).density.reachable_deg is not None


@out_of_reach
def test_the_pose_that_is_named_lies_down(advice: Advice) -> None:
    # The centre 5 above a foot of 10 × 120
    assert advice.poses_deg[0] == pytest.approx(45.0, abs=0.01)


def test_a_pose_lays_the_model_down() -> None:
    result = hollowed(solids.box(10, 10, 120), pose=1)
    assert result.part.manifold.bounding_box()[5] == pytest.approx(10.0, abs=1e-6)
    assert result.stability.tilt_deg == pytest.approx(45.0, abs=0.5)
    # The placement takes the model's own coordinates into the part's.
    corner = result.part.placement @ np.array([5.0, 5.0, 120.0, 1.0])
    assert np.abs(corner[:2]).max() == pytest.approx(60.0)
    assert np.abs(corner[:2]).min() == pytest.approx(5.0)
    with pytest.raises(UsageError, match="pose 99"):
        hollowed(solids.box(10, 10, 120), pose=99)


@pytest.mark.parametrize("size", [(16, 34, 9), pytest.param((24, 50, 14), marks=SLOW)])
def test_vaults_are_weighed_in_the_program(size: tuple[float, float, float]) -> None:
    # A tall box leaning a little: its flat ceiling is carried, and that mass is high up.
    prism = solids.leaning_prism(*size)
    options = {"base": "never", "lean": 6.0}
    plain = hollowed(prism, **options)
    held = hollowed(prism, vaults=None, **options)
    assert held.supports is not None and held.supports.columns > 0
    assert held.supports.unsupported_mm2 == 0 and held.supports.islands == 0
    assert held.mass_g > plain.mass_g
    assert held.stability.tilt_deg >= 6.0  # type: ignore[operator]
    certificate = held.density.certificate
    assert certificate is not None and certificate.gap <= 1e-6
    assert certificate.voxel_mass_g == pytest.approx(held.mass_g, rel=0.01)
    assert "support_material_buildplate_only" not in held.profile.slicer.object_settings
    # With a support blocker the key is not needed, which removes supports outside too.
    assert "support_material_buildplate_only" not in plain.profile.slicer.object_settings
    assert plain.supports is None and plain.blocker is not None


@pytest.mark.parametrize(("profile", "held"), [("fdm-pla-0.4", True), ("resin-standard", False)])
def test_supports_go_by_the_process(profile: str, held: bool) -> None:
    block = solids.box(20, 20, 20)
    result = hollowed(block, vaults=None, profile=profile, resolution=24)
    assert (result.supports is not None) == held


def test_supports_are_refused_where_the_process_has_none() -> None:
    with pytest.raises(UsageError, match="resin"):
        hollowed(solids.box(20, 20, 20), vaults="printer", profile="resin-standard", resolution=24)


@SLOW
def test_adam_comes_to_about_what_the_plane_is() -> None:
    prism = solids.leaning_prism(20, 60, 12)
    options = {"objective": "paper", "resolution": 32, "base": "never"}
    plane = hollowed(prism, **options)
    adam = hollowed(prism, solver="adam", **options)
    assert adam.density.planes is None
    assert adam.mass_g == pytest.approx(plane.mass_g, rel=0.05)
    assert adam.wall_min_mm is None or adam.wall_min_mm >= WALL - 0.05


@pytest.mark.parametrize("options", [{"solver": "adam"}, {"objective": "paper", "device": "cuda"}])
def test_a_solver_or_device_that_would_be_ignored_is_refused(options: dict[str, object]) -> None:
    with pytest.raises(UsageError, match="solver"):
        hollowed(solids.box(10, 10, 10), **options)
