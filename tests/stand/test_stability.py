"""Tilt angles in closed form, and their invariances."""

from __future__ import annotations

import numpy as np
import pytest
import solids
from hypothesis import given
from hypothesis import strategies as st

from printprep.stand.stability import stability

FIRST_LAYER = 0.2


def test_a_cube_tips_at_45_degrees() -> None:
    found = stability(solids.box(40, 40, 40), FIRST_LAYER)
    assert found.tilt_deg == pytest.approx(45.0, abs=1e-9)
    assert found.contact_area_mm2 == pytest.approx(1600)
    np.testing.assert_allclose(found.centre_of_mass_mm, [0, 0, 20], atol=1e-12)


@pytest.mark.parametrize(("x", "y", "z"), [(20, 30, 60), (50, 10, 15)])
def test_a_box_tips_over_its_shorter_side(x: float, y: float, z: float) -> None:
    found = stability(solids.box(x, y, z), FIRST_LAYER)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(min(x, y) / z)), abs=1e-9)
    assert found.weakest_azimuth_deg in ((0.0, 180.0) if x < y else (90.0, 270.0))


def test_a_cylinder() -> None:
    found = stability(solids.cylinder(10, 50, segments=512), FIRST_LAYER)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(10 / 25)), abs=0.01)


def test_a_cone_touches_a_little_inside_its_rim() -> None:
    found = stability(solids.cone(15, 60, segments=512), FIRST_LAYER)
    rim = 15 * (1 - FIRST_LAYER / 2 / 60)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(rim / 15)), abs=0.01)


def test_a_sphere_stands_on_its_first_layer() -> None:
    found = stability(solids.sphere(20, segments=512), FIRST_LAYER)
    rim = np.sqrt(2 * 20 * 0.1 - 0.1**2)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(rim / 20)), rel=0.01)


def test_a_prism_that_leans_too_far_has_a_negative_tilt() -> None:
    found = stability(solids.leaning_prism(20, 60, 50), FIRST_LAYER)
    # The foot is cut at 0.1 mm, where the shear has moved it by 50/600 mm.
    edge = 10 - 25 + 50 / 600
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(edge / 30)), abs=1e-6)
    assert found.weakest_azimuth_deg == pytest.approx(0.0, abs=1e-6)


def test_a_void_moves_the_centre_of_mass() -> None:
    hollow = solids.box(40, 40, 40) - solids.box(20, 20, 10).translate((0, 0, 25))
    expected = (64000 * 20 - 4000 * 30) / 60000
    found = stability(hollow, FIRST_LAYER)
    assert found.centre_of_mass_mm[2] == pytest.approx(expected)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(20 / expected)), abs=1e-9)


def test_the_weakest_of_several_bodies_counts() -> None:
    low, tall = solids.box(20, 20, 5), solids.box(5, 5, 60).translate((40, 0, 0))
    found = stability(low + tall, FIRST_LAYER)
    assert found.tilt_deg == pytest.approx(np.degrees(np.arctan(2.5 / 30)), abs=1e-9)


def test_what_does_not_touch_the_bed_has_no_tilt() -> None:
    found = stability(solids.box(10, 10, 10).translate((0, 0, 1)), FIRST_LAYER)
    assert found.tilt_deg is None and found.contact_area_mm2 == 0
    assert found.support_polygon_mm.shape == (0, 2)


@given(st.floats(-180, 180), st.floats(-50, 50), st.floats(-50, 50))
def test_turning_and_moving_on_the_bed_changes_nothing(turn: float, x: float, y: float) -> None:
    prism = solids.leaning_prism(20, 60, 10)
    reference = stability(prism, FIRST_LAYER)
    moved = stability(prism.rotate((0, 0, turn)).translate((x, y, 0)), FIRST_LAYER)
    assert moved.tilt_deg == pytest.approx(reference.tilt_deg, abs=1e-6)
    assert moved.contact_area_mm2 == pytest.approx(reference.contact_area_mm2, rel=1e-9)


@given(st.floats(0.2, 5))
def test_scaling_all_with_the_layer_changes_nothing(scale: float) -> None:
    prism = solids.leaning_prism(20, 60, 10)
    scaled = stability(prism.scale((scale, scale, scale)), FIRST_LAYER * scale)
    assert scaled.tilt_deg == pytest.approx(stability(prism, FIRST_LAYER).tilt_deg, abs=1e-6)
