"""What infill weighs, and the program on it, where both are known by hand."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from infill_parts import FOOT, SHEAR, TALL, leaning, solid_of, upright
from manifold3d import Manifold

from printprep.density.program import Program
from printprep.infill.estimate import (
    GYROID_SHARE,
    LIGHTNING_BELOW_MM,
    LIGHTNING_MM,
    ceilings,
    hanging,
    shell_mm,
    sparse_share,
)
from printprep.infill.fill import program_of
from printprep.infill.keys import layers, lines, object_keys, walls_mm
from printprep.infill.settle import settle_estimated, standing_of
from printprep.profiles import Profile, load_profile
from printprep.types import Lean


def profile_with(**settings: object) -> Profile:
    return load_profile(
        "fdm-pla-0.4", {key.replace("__", "."): value for key, value in settings.items()}
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


@given(side=st.floats(1, 50), tall=st.floats(1, 50), up=st.floats(0, 20))
def test_the_ceiling_of_a_box_is_its_top(side: float, tall: float, up: float):
    area, middle = ceilings(upright(side, tall).translate((3, -4, up)))
    assert area == pytest.approx(side**2, rel=1e-6)
    np.testing.assert_allclose(middle, [3, -4, up + tall], atol=1e-5)


def test_every_ceiling_counts_and_slopes_count_in_plan():
    two = upright(10, 5) + upright(10, 5).translate((0, 0, 20))
    area, middle = ceilings(two)
    assert area == pytest.approx(200)
    np.testing.assert_allclose(middle, [0, 0, 15], atol=1e-6)
    area, _ = ceilings(Manifold.sphere(10, 256))
    assert area == pytest.approx(np.pi * 100, rel=2e-3)


def test_lightning_hangs_and_gyroid_fills():
    room = upright(10, 30)
    lightning = profile_with().infill
    gyroid = profile_with(infill__pattern="gyroid").infill
    assert lightning is not None and gyroid is not None
    mm3 = LIGHTNING_MM * 100
    np.testing.assert_allclose(
        hanging(room, lightning), [mm3, 0, 0, mm3 * (30 - LIGHTNING_BELOW_MM)], atol=1e-6
    )
    assert sparse_share(lightning) == 0.0
    assert not hanging(room, gyroid).any()
    assert sparse_share(gyroid) == pytest.approx(GYROID_SHARE * 0.15)
    assert not hanging(Manifold(), lightning).any()


def program_for(pattern: str) -> tuple[Program, Profile]:
    profile = profile_with(infill__pattern=pattern, stability__lean_margin_deg=0.0)
    return program_of(solid_of(leaning()), profile, 40), profile


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
    assert program.unfilled(None)[0] == pytest.approx(expected, rel=0.01)


@pytest.mark.parametrize("pattern", ["lightning", "gyroid"])
def test_the_lightest_ballast_stands_as_asked_and_lies_below_a_plane(pattern: str):
    program, _ = program_for(pattern)
    lean = Lean(14.0)
    choice = program.choose("never", lean)
    found = settle_estimated(solid_of(leaning()), program, choice, 0.15)
    assert choice.reached == np.inf
    assert standing_of(program, choice).tilt_deg == pytest.approx(14.0, abs=1e-3)
    assert found.standing.tilt_deg == pytest.approx(14.0, abs=1e-3)
    assert found.moments[0] == pytest.approx(program.unfilled(None)[0] + found.ballast_mm3)
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
