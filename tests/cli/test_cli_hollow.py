"""``printprep hollow``: what it hands on, what it says, when it writes.

The method itself is another room's: here a cube with known figures stands in for it.
"""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from closed_form_parts import hollow_result

from printprep.cli.run import run
from printprep.pipeline.options import FillOptions, Placement
from printprep.profiles import load_profile
from printprep.types import Finding

TILT = Finding("tilt", "error", "It tips.", "Use a base.")


@pytest.fixture
def handed(monkeypatch, tmp_path):
    """What the command hands to the method; ``findings`` in it choose what the method finds."""
    seen: dict[str, object] = {"findings": None}

    def hollow_with(model, profile, placement, options, progress):
        seen.update(model=model, profile=profile, placement=placement, options=options)
        changes = {} if seen["findings"] is None else {"findings": seen["findings"]}
        return hollow_result(profile=profile, name=model.stem, **changes)

    monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", hollow_with)
    monkeypatch.chdir(tmp_path)
    return seen


def test_defaults_are_those_of_the_method(handed, capsys):
    assert run(["hollow", "in/model.stl"]) == 0
    assert handed["model"] == Path("in/model.stl")
    assert handed["profile"] == load_profile("fdm-pla-0.4")
    assert handed["placement"] == Placement()
    assert handed["options"] == FillOptions()
    assert Path("model-hollow.3mf").is_file()  # in the current folder, not beside the model
    assert "Written: model-hollow.3mf" in capsys.readouterr().out


def test_every_option_arrives(handed):
    line = (
        "hollow m.obj -o out.stl -p fdm-petg-0.4 --set printer.layer_height_mm=0.15 "
        "--set material.name=PC --wall 1.6 --lean 12.5 --units in --up -y --scale 2 --height 3 "
        "--size 4 --resolution 96 --objective paper --base never --fail-on error -q"
    )
    assert run(line.split()) == 0
    overrides = {"printer.layer_height_mm": 0.15, "material.name": "PC", "wall_mm": 1.6}
    assert handed["profile"] == load_profile("fdm-petg-0.4", overrides)
    assert handed["placement"] == Placement("in", "-y", 2.0, 3.0, 4.0)
    assert handed["options"] == FillOptions(
        lean="12.5", resolution=96, objective="paper", base="never", blocker=False
    )
    assert Path("out.stl").is_file()


def test_json_is_all_there_is_on_stdout(handed, capsys):
    assert run(["hollow", "m.stl", "-o", "out.3mf", "--json"]) == 0
    captured = capsys.readouterr()
    data = json.loads(captured.out)
    assert (data["model"], data["output"]) == ("m.stl", "out.3mf")
    assert captured.err == ""


def test_a_bare_format_comes_with_a_warning_in_the_right_order(handed, capsys):
    handed["findings"] = (TILT, Finding("nothing-to-hollow", "info", "Solid."))
    assert run(["hollow", "m.stl", "-o", "out.ply", "--json"]) == 0
    rules = [item["rule"] for item in json.loads(capsys.readouterr().out)["findings"]]
    assert rules == ["tilt", "no-settings", "nothing-to-hollow"]


def test_a_part_is_written_with_error_findings_too(handed, capsys):
    handed["findings"] = (TILT,)
    assert run(["hollow", "m.stl", "-o", "out.3mf"]) == 0
    assert Path("out.3mf").is_file()
    assert "It tips." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("fail_on", "suffix", "code"),
    [
        ("none", "stl", 0), ("error", "stl", 0), ("warning", "stl", 1), ("info", "stl", 1),
        ("warning", "3mf", 0), ("info", "3mf", 1),  # the sealed cavity is information
    ],
)  # fmt: skip
def test_fail_on_stops_before_anything_is_written(handed, capsys, fail_on, suffix, code):
    handed["findings"] = tuple(
        item for item in hollow_result().findings if item.rule == "sealed-cavity"
    )
    target = Path(f"out.{suffix}")
    target.write_text("old")
    assert run(["hollow", "m.stl", "-o", str(target), "--fail-on", fail_on, "--json"]) == code
    data = json.loads(capsys.readouterr().out)
    assert (data["output"] is None) == (code == 1)
    assert (target.read_bytes() == b"old") == (code == 1)


def test_stopped_it_says_so(handed, capsys):
    handed["findings"] = (TILT,)
    assert run(["hollow", "m.stl", "--fail-on", "error"]) == 1
    out = capsys.readouterr().out
    assert "Not written" in out
    assert "Written:" not in out
    assert not list(Path().iterdir())


def test_quiet_says_only_what_is_wrong_on_stderr(handed, capsys):
    handed["findings"] = (TILT, Finding("x", "info", "Nice."))
    assert run(["hollow", "m.stl", "-q"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == "printprep: error: It tips. Use a base.\n"


def test_verbose_adds_seconds(handed, capsys):
    assert run(["hollow", "m.stl", "-v"]) == 0
    assert "seconds" in capsys.readouterr().out


class TestBeforeTheLongWork:
    def test_unknown_suffix(self, handed, capsys):
        assert run(["hollow", "m.stl", "-o", "out.step"]) == 2
        assert "model" not in handed
        assert ".step is not a format" in capsys.readouterr().err

    def test_missing_folder(self, handed):
        assert run(["hollow", "m.stl", "-o", "nowhere/out.3mf"]) == 5
        assert "model" not in handed

    def test_the_model_itself_is_not_replaced(self, handed, capsys):
        Path("m.stl").write_text("solid")
        assert run(["hollow", "m.stl", "-o", "./m.stl"]) == 2
        assert "model" not in handed
        assert Path("m.stl").read_text() == "solid"

    @pytest.mark.parametrize("setting", ["wall_mm", "=3", " =3"])
    def test_a_setting_without_key_or_value(self, handed, setting):
        assert run(["hollow", "m.stl", "--set", setting]) == 2
        assert "model" not in handed

    def test_a_key_set_twice(self, handed, capsys):
        assert run(["hollow", "m.stl", "--wall", "2", "--set", "wall_mm=1"]) == 2
        assert "wall_mm is set twice" in capsys.readouterr().err
        assert run(["hollow", "m.stl", "--set", "a=2", "--set", "a=1"]) == 2
