"""What goes with --fill infill, and what is refused before the long work."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from infill_parts import leaning, mesh_of

from printprep.cli.run import run


@pytest.fixture
def model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "box.stl"
    mesh_of(leaning()).export(path)
    return path


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("-p resin-standard", "prints without infill"),
        ("-p sls-pa12", "prints without infill"),
        ("-o out.stl", "cannot carry infill"),
        ("--for cura", "only for PrusaSlicer, OrcaSlicer and BambuStudio"),
        ("--objective paper", "makes only cavities, not infill"),
        ("--vaults=printer", "--vaults printer has no effect with infill"),
        ("--drains 2 --drain-diameter 3", "has no cavities to drain"),
        ("--simulate", "simulation takes the mesh for solid"),
        ("--set infill.pattern=cubic", "infill.pattern"),
        ("--set infill.density=0", "infill.density"),
    ],
)
def test_what_makes_no_sense_is_a_usage_error(
    model: Path, options: str, said: str, capsys: pytest.CaptureFixture[str]
):
    assert run(["hollow", str(model), "--fill", "infill", *options.split()]) == 2
    assert said in " ".join(capsys.readouterr().err.split())
    assert list(model.parent.iterdir()) == [model]


def test_a_cavity_needs_no_slicer(model: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["hollow", str(model), "--slicer", "prusa-slicer"]) == 2
    assert "--fill infill" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("process", "named"), [("", True), ("-p resin-standard --no-drains", False)]
)
def test_the_summary_names_the_other_way(
    model: Path, capsys: pytest.CaptureFixture[str], process: str, named: bool
):
    line = ["hollow", str(model), "--base", "never", "--resolution", "32", "--no-self-support"]
    assert run([*line, *process.split()]) == 0
    out = capsys.readouterr().out
    assert ("g (--fill infill)" in out) == named
    assert ("--fill" in out) == named


def test_infill_is_for_filament_only(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert run(["profiles", "show", "resin-standard"]) == 0
    text = capsys.readouterr().out
    mine = tmp_path / "mine.toml"
    mine.write_text(text + '\n[infill]\npattern = "gyroid"\ndensity = 0.2\n', encoding="utf-8")
    assert run(["profiles", "show", str(mine)]) == 2
    assert "has no meaning for resin" in capsys.readouterr().err


def test_without_a_slicer_it_is_an_estimate_and_says_so(
    model: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("PRINTPREP_SLICER", raising=False)
    line = ["hollow", str(model), "--fill", "infill", "--lean", "14", "--base", "never"]
    assert run([*line, "--resolution", "32", "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["infill"]["weighed_with"] is None
    assert said["infill"]["slices"] == 0
    assert said["infill"]["ballast_g"] > 0
    assert said["tilt_deg"] == pytest.approx(14.5, abs=0.01)
    assert said["cavities"]["count"] == 0
    assert [item["rule"] for item in said["findings"]] == ["infill-estimated"]
    other = said["alternative_fill"]
    assert other["fill"] == "cavity"
    assert (
        run([*line, "--fill", "cavity", "--no-self-support", "--resolution", "32", "--json"]) == 0
    )
    hollow = json.loads(capsys.readouterr().out)
    assert other["mass_g"] == pytest.approx(hollow["mass_g"], rel=0.02)
    assert hollow["infill"] is None
    assert hollow["alternative_fill"] == {
        "fill": "infill",
        "mass_g": pytest.approx(said["mass_g"], rel=0.02),
    }
    assert run([*line, "--slicer", "/no/such/slicer"]) == 6
