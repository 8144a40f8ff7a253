"""``printprep simulate``, and ``hollow --simulate``: figures, pictures, exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import solids
from closed_form_parts import hollow_result

from printprep.cli.run import run
from printprep.mesh.write import to_bytes
from printprep.types import Settled, Simulation, Tipping


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("parts")
    (folder / "box.stl").write_bytes(to_bytes(solids.box(20, 30, 60), ".stl"))
    falling = solids.leaning_prism(20, 60, 50)
    (folder / "falling.stl").write_bytes(to_bytes(falling, ".stl"))
    return folder


def test_figures_beside_each_other(folder, capsys):
    assert run(["simulate", str(folder / "box.stl"), "--json"]) == 0
    captured = capsys.readouterr()
    assert captured.err == ""
    data = json.loads(captured.out)
    assert data["tilt_deg"] == pytest.approx(18.4349, abs=1e-3)
    assert data["lean_deg"] == 10
    assert data["findings"] == []
    simulation = data["simulation"]
    assert (simulation["stands"], simulation["rotation_deg"], simulation["seconds"]) == (
        True,
        0,
        10,
    )
    assert len(simulation["azimuths"]) == 8
    for item in simulation["azimuths"]:
        assert item["computed_deg"] < item["tips_deg"] < item["computed_deg"] + 0.3
        assert item["tips_deg"] < item["falls_deg"]


def test_a_lean_asked_for_and_not_reached_fails(folder, capsys):
    path = str(folder / "box.stl")
    assert run(["simulate", path, "--lean", "20"]) == 1
    out = capsys.readouterr().out
    assert "simulated-tip" in out
    assert "should stand at 20°" in out


def test_a_lean_not_reached_that_may_be_is_an_error_line_alone(folder, capsys):
    path = str(folder / "box.stl")
    assert run(["simulate", path, "--lean", "20", "--fail-on", "none", "-q"]) == 0
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("printprep: error: In simulation the part tips at")


def test_a_model_is_placed_before_it_is_let_go(folder):
    path = str(folder / "box.stl")
    assert run(["simulate", path, "--height", "20", "--up", "x", "--lean", "40"]) == 0


@pytest.mark.slow
def test_what_falls_by_itself_fails_and_is_drawn(folder, tmp_path, capsys):
    gif, strip = tmp_path / "fall.gif", tmp_path / "fall.png"
    path = str(folder / "falling.stl")
    assert run(["simulate", path, "--gif", str(gif), "--strip", str(strip)]) == 1
    assert "falls over: turned by" in capsys.readouterr().out
    assert gif.read_bytes()[:6] == b"GIF89a"
    assert strip.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"


@pytest.mark.parametrize(
    ("more", "code"),
    [
        (["--gif", "fall.png"], 2),
        (["--strip", "fall.gif"], 2),
        (["--gif", "nowhere/fall.gif"], 5),
        (["--lean", "61"], 2),
    ],
)
def test_what_cannot_be_meant_is_said_before_the_work(folder, monkeypatch, more, code):
    monkeypatch.chdir(folder)
    monkeypatch.setattr("printprep.stand.trial.trial", lambda *_: pytest.fail("simulated"))
    assert run(["simulate", "box.stl", *more]) == code


def test_hollow_simulates_on_request(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", lambda *_, **__: hollow_result())
    assert run(["hollow", "block.stl", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["simulation"] is None
    plain = (tmp_path / "block-hollow.3mf").read_bytes()

    assert run(["hollow", "block.stl", "--simulate", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["simulation"]["stands"]
    # The cube's middle is the cavity's: it tips at 45°.
    assert min(item["tips_deg"] for item in data["simulation"]["azimuths"]) == pytest.approx(
        45.15, abs=0.15
    )
    assert "simulation-disagrees" not in [item["rule"] for item in data["findings"]]
    assert (tmp_path / "block-hollow.3mf").read_bytes() == plain

    assert run(["hollow", "block.stl", "--simulate"]) == 0
    assert "stands for 10 s" in capsys.readouterr().out


def test_hollow_says_when_simulation_disagrees(monkeypatch, tmp_path, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", lambda *_, **__: hollow_result())
    other = Simulation(Settled(0.0, True, 10.0), (Tipping(0.0, 45.0, 31.0, 31.1),))
    monkeypatch.setattr("printprep.stand.trial.trial", lambda *_: other)
    line = ["hollow", "block.stl", "--simulate", "--json", "--fail-on", "warning"]
    assert run(line) == 1
    rules = [item["rule"] for item in json.loads(capsys.readouterr().out)["findings"]]
    assert "simulation-disagrees" in rules
    assert not (tmp_path / "block-hollow.3mf").exists()
