"""--dry-run: everything is checked and said, and nothing is written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
import trimesh

from printprep.cli.run import run


@pytest.fixture
def here(tmp_path, monkeypatch) -> Path:
    """A folder with a box of 20 × 30 × 40 mm in it, and a file that is no model."""
    trimesh.creation.box((20, 30, 40)).export(tmp_path / "box.stl")
    (tmp_path / "bad.stl").write_text("not a model")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture(autouse=True)
def nothing_is_written(here):
    def files() -> set[tuple[Path, int]]:
        return {(path, path.stat().st_mtime_ns) for path in here.rglob("*")}

    before = files()
    yield
    assert files() == before


def test_the_screen_says_what_would_be_done(here, capsys):
    line = (
        "hollow box.stl -o part.3mf --height 80 --lean 12 --report page.html --simulate --dry-run"
    )
    assert run(line.split()) == 0
    out = capsys.readouterr().out
    rows = {row[:14].strip(): row[14:].strip() for row in out.splitlines() if row}
    assert rows["model"] == "box.stl, 12 triangles"
    assert rows["size"] == "40 × 60 × 80 mm after placement"
    assert rows["profile"] == "fdm-pla-0.4: fdm, PLA"
    assert (rows["fill"], rows["vaults"], rows["should stand"]) == ("cavity", "printer", "at 12°")
    assert rows["then"] == "simulate"
    assert (rows["output"], rows["page"]) == ("part.3mf", "page.html")
    assert "drain holes" not in rows
    assert out.endswith("Nothing was written (--dry-run).\n")


@pytest.mark.parametrize(
    ("options", "facts"),
    [
        ([], {"vaults": "printer", "fill": "cavity", "output": "box-hollow.3mf"}),
        (["-o", "x.stl"], {"vaults": "slicer", "output": "x.stl"}),
        (["--vaults", "none"], {"vaults": "none"}),
        (["--fill", "infill"], {"vaults": None, "fill": "infill"}),
        (["-p", "sls-pa12", "--up", "x"], {"vaults": "none", "size_mm": [40, 30, 20]}),
        (["--pose", "1"], {"size_mm": [30, 40, 20]}),
        (["--lean", "15@90"], {"lean_deg": 15, "lean_azimuth_deg": 90}),
        (["--units", "in"], {"size_mm": [508, 762, 1016]}),
    ],
    ids=str,
)
def test_as_json(here, capsys, options, facts):
    assert run(["hollow", "box.stl", "--dry-run", "--json", *options]) == 0
    data = json.loads(capsys.readouterr().out)
    assert data["dry_run"] is True
    if options[:1] == [
        "--pose"
    ]:  # the steadiest pose lies on the largest face, turned as it may be
        assert sorted(data["size_mm"]) == [20, 30, 40]
        assert data["size_mm"][2] == 20
        return
    assert {key: data[key] for key in facts if key != "size_mm"} == {
        key: fact for key, fact in facts.items() if key != "size_mm"
    }
    if "size_mm" in facts:
        assert sorted(data["size_mm"]) == sorted(facts["size_mm"])


@pytest.mark.parametrize(
    ("options", "code"),
    [
        ("box.stl --lean steep", 2),
        ("box.stl --size 0", 2),
        ("box.stl --set printer.qqq=1", 2),
        ("box.stl -o part.xyz", 2),
        ("box.stl -o box.stl", 2),
        ("box.stl --plugs plugs.3mf", 2),
        ("box.stl --fill infill -o x.stl", 2),
        ("box.stl --pose 99", 2),
        ("bad.stl", 3),
        ("none.stl", 3),
        ("box.stl --max-memory 1", 3),
        ("box.stl -o nowhere/part.3mf", 5),
    ],
)
def test_it_ends_as_the_run_would(here, capsys, options, code):
    assert run(["hollow", *options.split(), "--dry-run"]) == code
    assert capsys.readouterr().out == ""


def test_quiet_says_nothing_where_all_is_well(here, capsys):
    assert run(["hollow", "box.stl", "--dry-run", "-q"]) == 0
    assert capsys.readouterr() == ("", "")


def test_a_batch_has_a_line_for_each_model(here, capsys):
    assert run(["batch", ".", "-o", "parts", "--dry-run", "--plugs", "-p", "sls-pa12"]) == 1
    bad, box, _, end = capsys.readouterr().out.splitlines()
    assert bad.startswith("bad.stl: input: ")
    assert box == "box.stl: 20 × 30 × 40 mm, sls-pa12, cavity, vaults none → parts/box.3mf"
    assert end == "2 models, 1 refused. Nothing was written (--dry-run)."
    assert run(["batch", "box.stl", "-o", "parts", "--dry-run", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["name"], data["status"], data["output"]) == ("box.stl", "ready", "parts/box.3mf")
    assert run(["batch", ".", "-o", "parts", "--dry-run", "--json"]) == 1
    rows = [json.loads(line) for line in capsys.readouterr().out.splitlines()]
    assert [row["status"] for row in rows] == ["input", "ready"]
    assert run(["batch", "box.stl", "-o", "parts", "--dry-run", "-q"]) == 0
    assert capsys.readouterr().out == ""


def test_a_batch_with_a_wrong_option_ends_before_its_models(here, capsys):
    assert run(["batch", ".", "-o", "parts", "--dry-run", "--lean", "steep"]) == 2
    assert "steep" in capsys.readouterr().err


def test_a_batch_into_what_cannot_be_a_folder(here, capsys):
    assert run(["batch", "box.stl", "-o", "bad.stl/parts", "--dry-run"]) == 5
    assert "bad.stl is no folder" in capsys.readouterr().err


def test_a_batch_over_its_own_models_is_told(here, capsys):
    assert run(["batch", "box.stl", "-o", ".", "--format", "stl", "--dry-run"]) == 1
    assert "box.stl: usage: box.stl is the model" in capsys.readouterr().out
