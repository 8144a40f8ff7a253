"""Let go and leaned in simulation: closed forms, bodies that fall, the same figures every time."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import solids
from manifold3d import Manifold

from printprep.check.simulated import disagreements, gap_deg, simulation_findings
from printprep.stand.directional import directional_tilt_deg
from printprep.stand.motion import Motion
from printprep.stand.scene import MOST_LEAN_DEG, scene_of
from printprep.stand.simulate import simulate
from printprep.stand.stability import stability
from printprep.stand.tilt_test import tilt_test, tip
from printprep.stand.trial import trial
from printprep.types import Lean, Settled, Simulation, Tipping

FIRST_LAYER = 0.2
TEN = Lean(10.0)


def degrees(opposite: float, adjacent: float) -> float:
    return float(np.degrees(np.arctan2(opposite, adjacent)))


def hollow_box() -> Manifold:
    """A 20 × 30 × 60 mm box, empty but for walls of 2 mm and a floor of 20 mm."""
    return solids.box(20, 30, 60) - solids.box(16, 26, 38).translate((0, 0, 20))


def hollow_box_centre() -> float:
    outer, inner = 20 * 30 * 60, 16 * 26 * 38
    return (outer * 30 - inner * 39) / (outer - inner)


CLOSED_FORMS = {
    "a cube": (lambda: solids.box(40, 40, 40), 0.0, 45.0),
    "a cube over its corner": (lambda: solids.box(40, 40, 40), 45.0, degrees(np.sqrt(2), 1)),
    "a box over its short side": (lambda: solids.box(20, 30, 60), 180.0, degrees(10, 30)),
    "a box over its long side": (lambda: solids.box(20, 30, 60), 90.0, degrees(15, 30)),
    "a hollow box": (hollow_box, 0.0, degrees(10, hollow_box_centre())),
    "a cylinder": (lambda: solids.cylinder(10, 50), 30.0, degrees(10, 25)),
    "a cone": (lambda: solids.cone(15, 60), 200.0, degrees(15 * (1 - 0.1 / 60), 15)),
    # The flat that the first layer makes of a ball: radius √(2 r h − h²) at h = 0.1 mm.
    "a ball": (lambda: solids.sphere(20), 0.0, degrees(np.sqrt(2 * 20 * 0.1 - 0.01), 20)),
    # Sheared by 10 mm over 60 mm; the foot is cut at 0.1 mm.
    "a leaning prism, onward": (lambda: solids.leaning_prism(20, 60, 10), 0.0,
                                degrees(10 - 5 + 1 / 60, 30)),
    "a leaning prism, back": (lambda: solids.leaning_prism(20, 60, 10), 180.0,
                              degrees(10 + 5 - 1 / 60, 30)),
    "a coin": (lambda: solids.cylinder(10, 6), 0.0, degrees(10, 3)),
    "a pin of a millimetre": (lambda: solids.box(1, 1, 100), 90.0, degrees(0.5, 50)),
    "a chip of a few millimetres": (lambda: solids.box(2, 2, 3), 0.0, degrees(1, 1.5)),
    "a crate of half a metre": (lambda: solids.box(200, 200, 500), 0.0, degrees(100, 250)),
}  # fmt: skip


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_it_tips_where_the_closed_form_says(name: str) -> None:
    make, azimuth, expected = CLOSED_FORMS[name]
    body = make()
    computed = directional_tilt_deg(stability(body, FIRST_LAYER), azimuth)
    # What a polygon of 256 corners loses to its circle.
    assert computed == pytest.approx(expected, abs=0.06)
    tips, falls = tip(scene_of(body, FIRST_LAYER), azimuth)
    # Never early, and late only by what the bed tilts while it falls.
    assert expected - 0.06 < tips < expected + 0.3
    assert tips < falls < tips + 0.4


def test_computed_toward_the_weakest_edge_is_the_tilt_angle_and_nowhere_less() -> None:
    standing = stability(solids.leaning_prism(20, 60, 8).rotate((0, 0, 33)), FIRST_LAYER)
    assert directional_tilt_deg(standing, standing.weakest_azimuth_deg) == pytest.approx(
        standing.tilt_deg, abs=1e-9
    )
    around = [directional_tilt_deg(standing, azimuth) for azimuth in range(0, 360, 3)]
    assert min(around) >= standing.tilt_deg
    assert max(around) > 2 * standing.tilt_deg


def test_what_stands_does_not_stir() -> None:
    for body in (solids.box(20, 30, 60), solids.cone(15, 60), solids.box(1, 1, 100)):
        found = simulate(body, FIRST_LAYER)
        assert found.stands
        assert found.rotation_deg < 1e-3


def test_what_leans_too_far_falls_by_itself() -> None:
    prism = solids.leaning_prism(20, 60, 50)
    found = trial(prism, FIRST_LAYER, TEN)
    assert not found.settled.stands
    assert found.settled.rotation_deg > 45
    assert all(item.tips_deg == item.falls_deg == 0 > item.computed_deg for item in found.tippings)
    assert [item.rule for item in simulation_findings(found, TEN)] == ["simulated-fall"]


def test_the_first_of_several_bodies_counts() -> None:
    stable, falling = solids.box(20, 20, 5), solids.leaning_prism(10, 30, 25).translate((60, 0, 0))
    assert simulate(stable, FIRST_LAYER).stands
    assert simulate(stable + falling, FIRST_LAYER) == simulate(falling, FIRST_LAYER)
    slim = solids.box(5, 5, 60).translate((40, 0, 0))
    together = tilt_test(stable + slim, FIRST_LAYER, azimuths=4)
    assert together == tilt_test(slim, FIRST_LAYER, azimuths=4)
    assert min(item.tips_deg for item in together) == pytest.approx(degrees(2.5, 30), abs=0.3)


def test_a_foot_that_comes_down_on_something_else_tips_but_does_not_go_over() -> None:
    # A column on a slim foot, and beside it an outrigger that hovers 1 mm over the bed.
    column = solids.box(10, 10, 60)
    outrigger = solids.box(40, 10, 3).translate((20, 0, 1))
    body = column + outrigger
    standing = stability(body, FIRST_LAYER)
    tips, falls = tip(scene_of(body, FIRST_LAYER), 0.0)
    assert tips == pytest.approx(directional_tilt_deg(standing, 0.0), abs=0.3)
    # It has turned by atan(1 / 35) about the foot's edge; then the outrigger's end is the edge.
    x, _, z = standing.centre_of_mass_mm
    assert falls == pytest.approx(degrees(40 - x, z - 1) - degrees(1, 35), abs=0.5)


def test_contact_with_nothing_is_not_standing_even_when_it_balances() -> None:
    needle = Manifold.cylinder(30, 0, 10, 64)
    found = trial(needle, FIRST_LAYER, TEN)
    assert not found.settled.stands
    assert found.tippings == ()


def test_a_flat_thing_outlasts_the_test() -> None:
    coin = solids.cylinder(40, 2, segments=64)
    (first, *_) = tilt_test(coin, FIRST_LAYER, azimuths=1)
    assert first.computed_deg > MOST_LEAN_DEG
    assert first.tips_deg is first.falls_deg is None
    assert gap_deg(first) == 0


@cache
def leaning_trial() -> Simulation:
    return trial(solids.leaning_prism(20, 60, 10), FIRST_LAYER, TEN)


def test_the_same_every_time() -> None:
    assert trial(solids.leaning_prism(20, 60, 10), FIRST_LAYER, TEN) == leaning_trial()


def test_azimuths_are_even_and_the_weakest_edge_is_among_them() -> None:
    assert [item.azimuth_deg for item in leaning_trial().tippings] == pytest.approx(
        [0, 45, 90, 135, 180, 225, 270, 315], abs=1e-6
    )
    turned = tilt_test(solids.leaning_prism(20, 60, 10).rotate((0, 0, 20)), FIRST_LAYER)
    assert [item.azimuth_deg for item in turned] == pytest.approx(
        [0, 20, 45, 90, 135, 180, 225, 270, 315], abs=1e-6
    )
    weakest = min(turned, key=lambda item: item.tips_deg)
    assert weakest.azimuth_deg == pytest.approx(20, abs=1e-6)
    assert weakest.tips_deg == pytest.approx(min(i.tips_deg for i in leaning_trial().tippings),
                                             abs=0.02)  # fmt: skip


def test_a_lean_toward_one_azimuth_is_judged_there_alone() -> None:
    prism = solids.leaning_prism(20, 60, 10)  # 9.5° onward, 26.5° back
    for lean, rules in (
        (Lean(15.0), ["simulated-tip"]),
        (Lean(15.0, 170.0), []),
        (Lean(28.0, 170.0), ["simulated-tip"]),
    ):
        found = trial(prism, FIRST_LAYER, lean)
        azimuths = [item.azimuth_deg for item in found.tippings]
        assert lean.azimuth_deg is None or lean.azimuth_deg in azimuths
        assert [item.rule for item in simulation_findings(found, lean)] == rules


def test_every_size_is_the_same_scene_but_for_its_gravity() -> None:
    scene = scene_of(hollow_box(), FIRST_LAYER)
    larger = scene_of(hollow_box().scale((3, 3, 3)), 3 * FIRST_LAYER)
    np.testing.assert_allclose(scene.points, larger.points, atol=1e-9)
    np.testing.assert_allclose(scene.inertia, larger.inertia, atol=1e-9)
    assert np.trace(scene.inertia) == pytest.approx(2)
    assert larger.gravity == pytest.approx(scene.gravity / 3)


def test_a_giant_and_a_dwarf_tip_at_the_same_lean() -> None:
    angles = [
        tip(scene_of(solids.leaning_prism(20 * k, 60 * k, 10 * k), FIRST_LAYER * k), 0.0)
        for k in (0.1, 1, 10)
    ]
    np.testing.assert_allclose(angles, np.broadcast_to(angles[1], (3, 2)), atol=0.05)


def test_a_free_fall_takes_the_time_it_takes() -> None:
    """Gravity in the scene's units: a box let go from a wall falls ½ g t²."""
    motion = Motion(scene_of(solids.box(20, 20, 20), FIRST_LAYER))
    motion.lean(90.0, 0.0)
    start = motion.position_mm
    motion.advance(100)
    moved = motion.position_mm - start
    assert moved[0] == pytest.approx(9810 * 0.1**2 / 2, rel=0.02)
    np.testing.assert_allclose(moved[1:], 0, atol=0.05)


def test_findings_say_what_a_simulation_found() -> None:
    def rules(tips: float | None, computed: float, lean: float) -> list[str]:
        tipping = Tipping(90.0, computed, tips, tips)
        simulation = Simulation(Settled(0.0, True, 10.0), (tipping,))
        return [item.rule for item in simulation_findings(simulation, Lean(lean))]

    assert rules(10.2, 10.0, 10.0) == []
    assert rules(9.8, 10.0, 10.0) == ["simulated-tip"]
    assert rules(8.8, 10.0, 5.0) == ["simulation-disagrees"]
    assert rules(8.8, 10.0, 10.0) == ["simulated-tip", "simulation-disagrees"]
    assert rules(0.0, -30.0, 0.0) == []
    assert rules(None, 85.0, 10.0) == []


@pytest.mark.corpus
@pytest.mark.parametrize("name", ["spot_low_resolution", "penguin"])
def test_a_hollowed_figure_stands_at_the_lean(dev_models, name: str) -> None:
    from printprep.pipeline.hollow import hollow

    model = dev_models[name]
    result = hollow(model.path, up=model.up, size_mm=60)
    found = trial(result.part.manifold, result.profile.printer.first_layer_mm, result.lean)
    assert found.settled.stands
    assert found.settled.rotation_deg < 0.01
    assert min(item.tips_deg for item in found.tippings) >= result.lean_deg
    assert list(disagreements(found)) == []
