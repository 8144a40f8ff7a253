"""The JSON of a result: keys, shapes, figures known by hand, and nothing private in the file."""

from __future__ import annotations

import json
import math

import pytest
from closed_form_parts import context, hollow_box, hollow_result

from printprep.check import run_rules
from printprep.output.numbers import number, to_text
from printprep.pipeline.check import Checked
from printprep.profiles import load_profile
from printprep.report.json import check_json, result_json
from printprep.types import Finding, Repair, Solid

KEYS = {
    "model", "output", "profile", "solid_mass_g", "mass_g", "tilt_solid_deg", "tilt_deg",
    "lean_deg", "wall_min_mm", "cavities", "base", "certificate", "findings", "repair", "seconds",
}  # fmt: skip


def test_all_promised_keys_with_their_figures():
    data = result_json(hollow_result(), model="in/block.stl", output="out.3mf")
    assert set(data) >= KEYS
    assert (data["model"], data["output"], data["profile"]) == (
        "in/block.stl", "out.3mf", "fdm-pla-0.4",
    )  # fmt: skip
    assert data["solid_mass_g"] == 9.92
    assert data["mass_g"] == 4.84096
    assert data["mass_ratio"] == 0.488
    assert data["tilt_solid_deg"] == data["tilt_deg"] == 45.0
    assert (data["lean_deg"], data["aim_deg"], data["reachable_deg"]) == (10.0, 10.5, None)
    assert data["cavities"] == {
        "count": 1,
        "items": [{"volume_mm3": 4096.0, "bounds_mm": [[-8.0, -8.0, 2.0], [8.0, 8.0, 18.0]]}],
    }
    assert data["base"] is None
    assert set(data["certificate"]) == {"voxel_mass_g", "bound_g", "gap"}
    assert data["certificate"]["gap"] == pytest.approx(1e-9 / 4.9, rel=1e-2)
    assert data["repair"]["rung"] == "as-is"
    assert data["seconds"] == {"read": 0.012, "solve": 1.0}
    assert data["placement"][0] == [1.0, 0.0, 0.0, 1.5]


def test_without_a_name_the_model_is_its_stem_and_output_is_null():
    data = result_json(hollow_result())
    assert (data["model"], data["output"]) == ("block", None)


def test_base_weighs_what_it_adds():
    # A plate of 24 × 24 × 1 mm less the 20 × 20 mm of the foot: 176 mm³ of PLA.
    data = result_json(hollow_result(with_base=True))
    assert data["base"] == {"seat_mm": 1.0, "growth_mm": 2.0, "mass_g": 0.21824}


def test_findings_have_every_field():
    finding = Finding("tilt", "error", "falls", value=1 / 3, at_mm=(0.00049, -1e-9, 2))
    (data,) = result_json(hollow_result(findings=(finding,)))["findings"]
    assert data == {
        "rule": "tilt", "severity": "error", "message": "falls", "fix": None,
        "value": 0.333333, "limit": None, "unit": None, "at_mm": [0.0, 0.0, 2.0],
        "area_mm2": None, "volume_mm3": None,
    }  # fmt: skip


def test_the_embedded_form_holds_no_time_path_or_output():
    data = hollow_result().figures().to_json()
    assert not {"seconds", "output"} & set(data)
    assert data["model"] == "block"
    assert set(data) | {"seconds", "output", "simulation"} == set(result_json(hollow_result()))


def test_overridden_settings_are_told():
    profile = load_profile("fdm-pla-0.4", {"wall_mm": 1.6})
    assert result_json(hollow_result(profile=profile))["settings"]["wall_mm"] == 1.6


def test_it_is_plain_json_and_refuses_what_is_no_number():
    text = to_text(result_json(hollow_result()))
    assert text.isascii()
    assert json.loads(text) == result_json(hollow_result())
    with pytest.raises(ValueError, match="Out of range"):
        to_text(result_json(hollow_result(mass_g=math.nan)))


def test_numbers_lose_their_noise_digits():
    assert number(0.1 + 0.2) == 0.3
    assert number(1234567.891) == 1234570.0
    assert math.copysign(1, number(-0.0)) == 1
    assert number(None) is None


def test_repair_is_told_in_full():
    repair = Repair("remesh", ("remade",), 0.123456, 0.01, 0.5)
    done = hollow_result()
    solid = Solid(done.solid.manifold, "block", repair, done.solid.placement)
    assert result_json(hollow_result(solid=solid))["repair"] == {
        "rung": "remesh", "actions": ["remade"], "moved_max_mm": 0.1235,
        "moved_mean_mm": 0.01, "resolution_mm": 0.5,
    }  # fmt: skip


def test_check_tells_size_mass_and_wall():
    profile = load_profile("fdm-pla-0.4")
    examined = context(hollow_box(20, 2))
    data = check_json(Checked(examined, run_rules(examined, profile), profile), model="x.stl")
    assert data["size_mm"] == [20.0, 20.0, 20.0]
    assert (data["volume_mm3"], data["mass_g"], data["wall_min_mm"]) == (3904.0, 4.84096, 2.0)
    assert data["cavities"]["count"] == 1
    found = [item["rule"] for item in data["findings"]]
    assert found == ["unsupported-ceiling", "sealed-cavity"]
