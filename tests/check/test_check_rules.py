"""Each rule: silent on a sound part, exact figures on a failing one, both sides of its limit."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from closed_form_parts import box, context, hollow_box, roofed
from manifold3d import Manifold

from printprep.check import RULES, run_rules
from printprep.check.registry import at_or_above, rule
from printprep.types import Finding, Repair, Stability


def found(rule_id, part, profile, **changes):
    return [item for item in run_rules(context(part, **changes), profile) if item.rule == rule_id]


def only(rule_id, part, profile, **changes):
    (finding,) = found(rule_id, part, profile, **changes)
    return finding


def test_a_sound_part_raises_nothing_but_information(fdm):
    findings = run_rules(context(roofed(30)), fdm)
    assert [(item.rule, item.severity) for item in findings] == [("sealed-cavity", "info")]


def test_every_rule_has_an_id_of_its_own_and_says_what_it_prevents():
    assert set(RULES) == {
        "drain-filled",
        "coarse-facets",
        "contact-area",
        "degenerate-triangles",
        "drain-too-small",
        "fits-bed",
        "gap",
        "lean-out-of-reach",
        "min-feature",
        "no-contact",
        "no-vent",
        "non-manifold-edges",
        "nothing-to-hollow",
        "open-surface",
        "orientation",
        "overhang-area",
        "overlapping-shells",
        "repaired",
        "sealed-cavity",
        "self-intersection",
        "support-blocker",
        "suction-cup",
        "tilt",
        "tiny-model",
        "trapped-volume",
        "unsupported-ceiling",
        "void-filled",
        "void-kept",
        "wall-thickness",
        "watertight",
    }
    for check in RULES.values():
        first_word = (check.__doc__ or "").split()[0]
        assert first_word in {"Prevents", "Tells", "Explains"}


def test_an_id_is_given_out_once():
    with pytest.raises(ValueError, match="two rules are called tilt"):
        rule("tilt")(lambda context, profile: ())


def test_findings_come_worst_first_then_by_id(resin):
    floating = hollow_box(0.5, 0.1).translate((0, 0, 3))
    findings = run_rules(context(floating, hollowed=True, cavities=()), resin)
    keys = [({"error": 0, "warning": 1, "info": 2}[item.severity], item.rule) for item in findings]
    assert keys == sorted(keys)
    assert {"no-contact", "tiny-model", "sealed-cavity", "nothing-to-hollow"} == {
        item.rule for item in findings
    }


def test_at_or_above_keeps_the_worse():
    all_of_them = [Finding("a", "info", ""), Finding("b", "warning", ""), Finding("c", "error", "")]
    assert [item.rule for item in at_or_above(all_of_them, "warning")] == ["b", "c"]
    assert [item.rule for item in at_or_above(all_of_them, "info")] == ["a", "b", "c"]


class TestWall:
    @pytest.mark.parametrize(("wall", "count"), [(1.2, 0), (1.151, 0), (1.149, 1), (0.3, 1)])
    def test_its_limit_is_the_profile_less_the_tolerance(self, fdm, wall, count):
        findings = found("wall-thickness", hollow_box(20, wall), fdm)
        assert len(findings) == count
        for item in findings:
            assert item.value == pytest.approx(wall, abs=1e-6)
            assert item.limit == 1.2
            assert item.unit == "mm"
            assert item.severity == "error"

    def test_its_place_lies_in_the_wall(self, fdm):
        lopsided = box(20) - box(16, z=0.7)
        item = only("wall-thickness", lopsided, fdm)
        assert item.value == pytest.approx(0.7, abs=1e-6)
        assert item.at_mm[2] == pytest.approx(0.35, abs=1e-5)

    def test_no_cavity_no_wall(self, fdm):
        assert context(box(20)).wall is None
        assert not found("wall-thickness", box(20), fdm)

    def test_two_edges_that_cross_are_nearer_than_any_vertex(self):
        # A ridge of the cavity along x at z = 12, a groove of the outside along y at z = 13: their
        # edges cross 1 mm apart over the origin, far from every vertex and face centre.
        ridge = Manifold.hull_points(
            [(-15, -8, 4), (-15, 8, 4), (-15, 0, 12), (15, -8, 4), (15, 8, 4), (15, 0, 12)]
        )
        groove = Manifold.hull_points(
            [(0, -30, 13), (-9, -30, 40), (9, -30, 40), (0, 30, 13), (-9, 30, 40), (9, 30, 40)]
        )
        outside = box(50, 30) - groove
        assert context(outside - ridge).wall.value_mm == pytest.approx(1.0, abs=1e-5)

    def test_a_cavity_that_breaks_through_has_no_wall(self):
        examined = replace(context(box(20)), cavities=(box(10, z=15),))
        assert examined.wall.value_mm == 0.0

    def test_a_loose_piece_inside_is_no_outside(self):
        part = hollow_box(20, 2) + box(15.9, z=2.05)
        examined = context(part)
        assert examined.wall.value_mm == pytest.approx(2.0, abs=1e-5)
        assert sum(void.volume() for void in examined.cavities) == pytest.approx(
            16**3 - 15.9**3, rel=1e-5
        )

    def test_spherical_wall(self):
        ball = Manifold.sphere(20, 96).translate((0, 0, 20))
        part = ball - Manifold.sphere(18, 96).translate((0, 0, 20))
        # Same facets on both: planes at r·cos of half a facet, so 2 mm times a cosine near one.
        assert 2 * 0.998 < context(part).wall.value_mm <= 2.0


class TestSealedCavity:
    @pytest.mark.parametrize(
        ("name", "severity"), [("fdm", "info"), ("resin", "error"), ("powder", "error")]
    )
    def test_severity_by_process(self, request, name, severity):
        item = only("sealed-cavity", hollow_box(20, 2), request.getfixturevalue(name))
        assert item.severity == severity
        assert item.value == pytest.approx(4096, rel=1e-6)
        assert item.unit == "mm3"
        assert item.at_mm == pytest.approx((0, 0, 10), abs=1e-6)
        assert "4.1 cm³" in item.message

    def test_several_are_added_up(self, resin):
        part = box(40) - box(10, z=5) - box(10, z=20)
        item = only("sealed-cavity", part, resin)
        assert item.value == pytest.approx(2000, rel=1e-6)
        assert item.message.startswith("2 sealed cavities")

    def test_an_open_cup_is_not_sealed(self, resin):
        assert not found("sealed-cavity", box(20) - box(16, height=20, z=2), resin)


class TestStanding:
    @pytest.mark.parametrize(("tilt_deg", "count"), [(10.01, 0), (9.99, 1), (5.0, 1)])
    def test_a_column_tips_at_its_slenderness(self, fdm, tilt_deg, count):
        # A column b wide and h high tips at atan(b / h).
        findings = found("tilt", box(20, 20 / math.tan(math.radians(tilt_deg))), fdm)
        assert len(findings) == count
        for item in findings:
            assert item.value == pytest.approx(tilt_deg, abs=1e-6)
            assert item.limit == 10.0
            assert item.unit == "deg"
            assert "should stand at 10°" in item.message

    def test_what_tips_by_itself_is_told_so(self, fdm):
        bent = box(4, 10) + box(30, 4, z=10).translate((14, 0, 0))
        item = only("tilt", bent, fdm)
        assert item.value < 0
        assert "by itself" in item.message

    def test_a_floating_body_has_no_contact(self, fdm):
        part = box(10) + box(5, z=20)
        item = only("no-contact", part, fdm)
        assert item.at_mm == pytest.approx((0, 0, 22.5))
        assert not found("tilt", part, fdm)

    def test_out_of_reach_names_both_angles_and_tilt_tells_too(self, fdm):
        column = box(10, 100)
        item = only("lean-out-of-reach", column, fdm, hollowed=True, reachable_deg=8.25)
        assert (item.value, item.limit) == (8.25, 10.0)
        assert "8.2°" in item.message
        assert "10°" in item.message
        assert "5.7°" in item.message
        # `check` of the written file cannot know why it tips, and says that it does.
        assert only("tilt", column, fdm, hollowed=True, reachable_deg=8.25).limit == 10.0

    def test_out_of_reach_even_upright(self, fdm):
        item = only("lean-out-of-reach", box(10), fdm, hollowed=True, reachable_deg=-3.0)
        assert "No filling" in item.message
        assert item.severity == "error"


class TestSize:
    def test_the_bed_is_a_limit_from_both_sides(self, fdm):
        exact = Manifold.cube((250, 210, 210))
        assert not found("fits-bed", exact, fdm)
        item = only("fits-bed", Manifold.cube((250.1, 210, 210)), fdm)
        assert (round(item.value, 3), item.limit) == (250.1, 250)
        assert item.severity == "error"

    def test_a_quarter_turn_fits(self, fdm):
        assert not found("fits-bed", Manifold.cube((200, 240, 50)), fdm)

    def test_the_size_it_offers_fits(self, fdm):
        part = Manifold.cube((300, 100, 260))
        item = only("fits-bed", part, fdm)
        assert "--size 242.3" in item.fix  # 300 × 210 / 260
        assert not found("fits-bed", part.scale((242.3 / 300,) * 3), fdm)

    def test_what_would_fit_lying_is_told_to_lie_down(self, fdm):
        assert "--up" in only("fits-bed", Manifold.cube((50, 50, 240)), fdm).fix

    def test_far_too_large_is_a_matter_of_units(self, fdm):
        assert "--units" in only("fits-bed", box(2600), fdm).fix

    @pytest.mark.parametrize(("side", "count"), [(0.999, 1), (1.0, 0)])
    def test_tiny(self, fdm, side, count):
        findings = found("tiny-model", box(side), fdm)
        assert len(findings) == count
        for item in findings:
            assert item.value == pytest.approx(side, abs=1e-6)
            assert "--units m" in item.fix
            assert "--size" in item.fix


class TestWhatBecameOfIt:
    def test_nothing_to_hollow_is_said_of_our_parts_only(self, fdm):
        assert only("nothing-to-hollow", box(5), fdm, hollowed=True).severity == "info"
        assert not found("nothing-to-hollow", box(5), fdm)
        assert not found("nothing-to-hollow", hollow_box(20, 2), fdm, hollowed=True)

    @pytest.mark.parametrize(
        ("rung", "severity"), [("union", "info"), ("meshlab", "warning"), ("remesh", "warning")]
    )
    def test_a_file_that_needed_repair(self, fdm, rung, severity):
        repair = Repair(rung, ("closed 3 holes.", "joined 2 shells"), moved_max_mm=0.02)
        item = only("repaired", box(20), fdm, repair=repair)
        assert item.severity == severity
        assert "closed 3 holes; joined 2 shells" in item.message

    @pytest.mark.parametrize(("moved", "count"), [(0.1, 0), (0.11, 1)])
    def test_a_part_of_ours_only_where_the_surface_moved(self, fdm, moved, count):
        repair = Repair("remesh", ("remade at 0.5 mm",), moved_max_mm=moved)
        findings = found("repaired", box(20), fdm, repair=repair, hollowed=True)
        assert [item.severity for item in findings] == ["warning"] * count


class TestWatertight:
    def test_inside_out(self, fdm):
        from printprep.mesh.measure import inverted

        standing = Stability(np.zeros((0, 2)), 0.0, (0, 0, 0), None, None, None)
        examined = replace(context(box(10)), part=inverted(box(10)), stability=standing)
        (item,) = [item for item in run_rules(examined, fdm) if item.rule == "watertight"]
        assert item.value == pytest.approx(-1000)

    def test_edges_that_touch_are_counted_where_they_are(self, fdm):
        touching = box(10) + box(10).translate((10, 10, 0))
        examined = replace(context(box(10)), part=touching)
        (item,) = [item for item in run_rules(examined, fdm) if item.rule == "watertight"]
        assert item.value == 2  # one edge, each way
        assert item.at_mm == pytest.approx((5, 5, 5))

    def test_what_the_kernel_refuses(self, fdm):
        from printprep.mesh.measure import try_manifold

        open_sheet, status = try_manifold(np.eye(3), np.array([[0, 1, 2]]))
        assert status == "NotManifold"
        (item,) = RULES["watertight"](replace(context(box(10)), part=open_sheet), fdm)
        assert "NotManifold" in item.message
