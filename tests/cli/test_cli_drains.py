"""``hollow``'s options for drains, and what it says of the drains there are."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from closed_form_parts import hollow_result

from printprep.cli.run import run
from printprep.profiles import load_profile
from printprep.types import Drain, Drainage

DRAINS = Drainage(
    (
        Drain("outlet", 0, (10.0, 0.0, 4.0), (1.0, 0.0, 0.0), 3.5, 2.0),
        Drain("vent", 0, (-10.0, 0.0, 15.0), (-1.0, 0.0, 0.0), 3.5, 2.0),
    ),
    filled_mm3=500.0,
    closed_mm3=(800.0,),
)


@pytest.fixture
def handed(monkeypatch, tmp_path):
    """What the command hands to the method, which finds a cube with ``drainage``."""
    seen: dict[str, object] = {"drainage": DRAINS}

    def hollow_with(model, profile, placement, options, progress):
        seen.update(profile=profile, placement=placement, options=options, model=model)
        return hollow_result(profile=profile, name=model.stem, drainage=seen["drainage"])

    monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", hollow_with)
    monkeypatch.chdir(tmp_path)
    return seen


@pytest.mark.parametrize(
    ("options", "keys"),
    [
        ("", {}),
        ("--drains 4", {"drain.count": 4}),
        ("--drain-diameter 5", {"drain.diameter_mm": 5.0}),
        ("--drains 3 --drain-diameter 2.5", {"drain.count": 3, "drain.diameter_mm": 2.5}),
        ("--no-drains", {"drain.count": 0}),
        ("--drains 0", {"drain.count": 0}),
    ],
)
def test_options_change_the_profile(handed, options, keys):
    assert run(f"hollow m.stl -p resin-standard {options}".split()) == 0
    assert handed["profile"] == load_profile("resin-standard", keys)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--drains 2 --no-drains", "exclude each other"),
        ("--drain-diameter 3 --no-drains", "--drain-diameter has no effect without drain holes"),
        ("--drains 0 --drain-diameter 3", "--drain-diameter has no effect without drain holes"),
        ("--no-drains --plugs p.3mf", "--plugs has no effect"),
        ("--plugs p.stl", "--plugs writes only .3mf"),
        ("--plugs m-hollow.3mf", "is the part, which would be replaced"),
        ("--drain-diameter 0", "drain.diameter_mm"),
        ("--drains 3 --set drain.count=2", "drain.count is set twice"),
    ],
)
def test_what_makes_no_sense_is_refused(handed, capsys, options, said):
    assert run(f"hollow m.stl -p resin-standard {options}".split()) == 2
    assert said in capsys.readouterr().err
    assert "model" not in handed


def test_a_folder_that_is_not_there_is_found_out_first(handed, capsys):
    assert run(["hollow", "m.stl", "-p", "resin-standard", "--plugs", "nowhere/p.3mf"]) == 5
    assert "does not exist" in capsys.readouterr().err
    assert "model" not in handed


@pytest.mark.parametrize("options", ["--drain-diameter 3", "--plugs p.3mf"])
def test_filament_has_no_drains_to_speak_of(handed, capsys, options):
    assert run(f"hollow m.stl {options}".split()) == 2
    assert "--drains N" in capsys.readouterr().err


def test_plugs_are_written_beside_the_part(handed):
    assert run(["hollow", "m.stl", "-p", "resin-standard", "--plugs", "p.3mf"]) == 0
    assert Path("p.3mf").is_file() and Path("m-hollow.3mf").is_file()


def test_no_drains_no_plugs(handed, capsys):
    handed["drainage"] = Drainage((), 0.0, ())
    assert run(["hollow", "m.stl", "-p", "resin-standard", "--plugs", "p.3mf"]) == 0
    assert not Path("p.3mf").exists()
    assert "p.3mf was not written" in capsys.readouterr().out


def test_the_summary_counts_them(handed, capsys):
    assert run(["hollow", "m.stl", "-p", "resin-standard"]) == 0
    said = " ".join(capsys.readouterr().out.split())
    assert "2 of 3.5 mm (1 outlet, 1 vent), 0.5 cm³ of floors filled" in said


def test_json_has_every_drain(handed, capsys):
    assert run(["hollow", "m.stl", "-p", "resin-standard", "--json"]) == 0
    drains = json.loads(capsys.readouterr().out)["drains"]
    assert drains["count"] == 2
    assert drains["filled_mm3"] == 500.0 and drains["closed_mm3"] == [800.0]
    assert drains["items"][1] == {
        "role": "vent",
        "cavity": 0,
        "centre_mm": [-10.0, 0.0, 15.0],
        "axis": [-1.0, 0.0, 0.0],
        "diameter_mm": 3.5,
        "length_mm": 2.0,
    }
