"""What infill weighs, and the program on it, where both are known by hand."""

from __future__ import annotations

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from infill_parts import FOOT, SHEAR, TALL, leaning, solid_of, upright
from manifold3d import Manifold

from printprep.density.program import Program
from printprep.grid.depth import Depths
from printprep.infill.ballast import estimated_ballast, stability_of_choice
from printprep.infill.estimate import (
    GYROID_SHARE,
    LIGHTNING_BELOW_MM,
    LIGHTNING_MM,
    hanging,
    infill_program,
    measured_depths,
    shell_mm,
    sparse_share,
)
from printprep.infill.moment_field import moment_field_of
from printprep.output.prusa_keys import layers, lines, object_keys, walls_mm
from printprep.profiles import Profile, load_profile
from printprep.types import Lean


def profile_with(**changes: object) -> Profile:
    return load_profile(
        "fdm-pla-0.4", {key.replace("__", "."): value for key, value in changes.items()}
    )


def test_walls_are_the_least_lines_and_layers_as_thick_as_the_wall():
    profile = load_profile()
    # 0.45 mm lines, spaced 0.45 − 0.2 (1 − π/4) = 0.40708 mm; layers of 0.2 mm
    assert (lines(profile), layers(profile)) == (3, 6)
    assert walls_mm(profile) == (pytest.approx(0.45 + 2 * 0.4070796), pytest.approx(1.2))
    assert lines(profile_with(wall_mm=1.6)) == 4
    assert lines(profile_with(infill__perimeters=2)) == 2


def test_the_object_carries_its_infill_and_nothing_for_cavities():
    keys = object_keys(profile_with(infill__density=0.125, infill__pattern="gyroid"))
    assert keys == {
        "perimeters": "3",
        "top_solid_layers": "6",
        "bottom_solid_layers": "6",
        "fill_density": "12.5%",
        "fill_pattern": "gyroid",
    }


def depths_of(manifold: Manifold) -> Depths:
    return measured_depths(solid_of(manifold), load_profile(), 40)


@examples(10)
@given(side=st.floats(12, 50), tall=st.floats(12, 50), level=st.floats(1.0, 1.3))
def test_the_room_of_a_box_is_a_box_and_its_ceiling_the_top(side: float, tall: float, level: float):
    depths = depths_of(upright(side, tall))
    room = moment_field_of(depths, level)
    x, y, z = 0.0, 0.0, tall / 2
    # A cell of the fine field across an edge of the room counts by distance: a hundredth of it
    volume = (side - 2 * level) ** 2 * (tall - 2 * level)
    found = room.volume.sum(axis=(1, 2, 3))
    assert found[0] == pytest.approx(volume, rel=0.01)
    np.testing.assert_allclose(found[1:] / found[0], [x, y, z], atol=0.02)
    found = room.ceiling.sum(axis=(1, 2, 3))
    assert found[0] == pytest.approx((side - 2 * level) ** 2, rel=0.01)
    np.testing.assert_allclose(found[1:] / found[0], [x, y, tall - level], atol=0.05)


def test_every_ceiling_counts_and_slopes_count_in_plan():
    two = upright(20, 10) + upright(20, 10).translate((0, 0, 20))
    ceiling = moment_field_of(depths_of(two), 1.0).ceiling.sum(axis=(1, 2, 3))
    assert ceiling[0] == pytest.approx(2 * 18**2, rel=0.01)
    assert ceiling[3] / ceiling[0] == pytest.approx((9 + 29) / 2, abs=0.05)
    ball = Manifold.sphere(15, 128).translate((0, 0, 15))
    ceiling = moment_field_of(depths_of(ball), 1.0).ceiling.sum(axis=(1, 2, 3))
    assert ceiling[0] == pytest.approx(np.pi * 14**2, rel=0.01)
    # The middle of a dome is two thirds up
    assert ceiling[3] / ceiling[0] == pytest.approx(15 + 14 * 2 / 3, abs=0.1)


def test_a_model_thinner_than_its_walls_has_no_room():
    room = moment_field_of(depths_of(upright(20, 1.5)), 1.0)
    assert not room.volume.any() and not room.ceiling.any()


def test_lightning_hangs_and_gyroid_fills():
    lightning = profile_with().infill
    gyroid = profile_with(infill__pattern="gyroid").infill
    assert lightning is not None and gyroid is not None
    ceiling = 100 * np.array([1.0, 2.0, 3.0, 30.0])
    mm3 = LIGHTNING_MM * 100
    np.testing.assert_allclose(
        hanging(ceiling, lightning), mm3 * np.array([1.0, 2.0, 3.0, 30 - LIGHTNING_BELOW_MM])
    )
    assert sparse_share(lightning) == 0.0
    assert not hanging(ceiling, gyroid).any()
    assert sparse_share(gyroid) == pytest.approx(GYROID_SHARE * 0.15)


def program_for(pattern: str) -> tuple[Program, Profile]:
    profile = profile_with(infill__pattern=pattern, stability__lean_margin_deg=0.0)
    solid = solid_of(leaning())
    return infill_program(solid, measured_depths(solid, profile, 40), profile), profile


@pytest.mark.parametrize("pattern", ["lightning", "gyroid"])
def test_a_box_without_ballast_weighs_its_shell_and_its_infill(pattern: str):
    """Volume of a sheared box is that of the upright one; sheared walls are thinner across."""
    program, profile = program_for(pattern)
    wall = shell_mm(profile)
    across = wall * np.hypot(1, SHEAR / TALL)  # the sloping walls, measured along x
    room = (FOOT - 2 * across) * (FOOT - 2 * wall) * (TALL - 2 * wall)
    top = LIGHTNING_MM * (FOOT - 2 * across) * (FOOT - 2 * wall)
    # The upper of the two sloping walls faces the room from above too
    sloping = LIGHTNING_MM * (FOOT - 2 * wall) * SHEAR * (TALL - 2 * wall) / TALL
    sparse = GYROID_SHARE * 0.15 * room if pattern == "gyroid" else top + sloping
    expected = FOOT**2 * TALL - room + sparse
    assert program.unfilled(None)[0, 0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("pattern", ["lightning", "gyroid"])
def test_the_lightest_ballast_stands_as_asked_and_lies_below_a_plane(pattern: str):
    program, _ = program_for(pattern)
    lean = Lean(14.0)
    choice = program.choose("never", lean)
    found = estimated_ballast(solid_of(leaning()), program, choice, 0.15)
    assert choice.reached == np.inf
    assert stability_of_choice(program, choice).tilt_deg == pytest.approx(14.0, abs=1e-3)
    assert found.stability.tilt_deg == pytest.approx(14.0, abs=1e-3)
    assert found.moments[0] == pytest.approx(program.unfilled(None)[0, 0] + found.ballast_mm3)
    (ballast,) = found.ballast
    (plane,) = found.density.planes
    assert plane is not None and plane.normal[2] > 0
    # The ballast is the box below the plane: the parts above and below make the box
    assert ballast.trim_by_plane(plane.normal, plane.offset_mm + 1e-6).volume() < 1e-6
    above = leaning().trim_by_plane(plane.normal, plane.offset_mm)
    assert above.volume() + ballast.volume() == pytest.approx(FOOT**2 * TALL)


def test_weighing_otherwise_changes_the_moments_and_nothing_else():
    program, _ = program_for("lightning")
    more = np.array([100.0, 600.0, 0.0, 3900.0])  # near the top
    other = program.weighing([program.moments[0] + more])
    np.testing.assert_allclose(other.unfilled(None), program.unfilled(None) + more)
    # A weight high up calls for more ballast
    light, heavy = (each.choose("never", Lean(14.0)) for each in (program, other))
    assert heavy.volume_mm3 > light.volume_mm3 + 100
