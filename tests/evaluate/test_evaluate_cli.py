"""``printprep evaluate`` from arguments to files, on two small models."""

from __future__ import annotations

import csv
import json

import pytest
from evaluate_models import write_boxes

from printprep.cli.evaluate import METHODS
from printprep.cli.run import run
from printprep.evaluate.methods import MAIN


@pytest.fixture
def models(tmp_path):
    folder = tmp_path / "models"
    folder.mkdir()
    write_boxes(folder / "cube.obj", ((0, 0, 0), (10, 10, 10)))
    write_boxes(folder / "lamp.obj", ((4, 4, 0), (6, 6, 10)), ((0, 0, 8), (10, 10, 12)))
    return folder


ABLATED = pytest.param(["--ablations"], marks=pytest.mark.slow, id="ablations")


@pytest.mark.parametrize("more", [pytest.param([], id="main"), ABLATED])
def test_the_whole_way(models, tmp_path, capsys, more):
    out = tmp_path / "out"
    arguments = ["evaluate", str(models), "-o", str(out), "--resolution", "16", *more]
    assert run(arguments) == 0
    said = capsys.readouterr()
    assert said.out == (out / "tables.md").read_text(encoding="utf-8")
    assert said.err.splitlines() == ["1/2 cube", "2/2 lamp"]
    with (out / "table.csv").open(newline="") as handle:
        rows = list(csv.DictReader(handle))
    by_method = {name: [row for row in rows if row["method"] == name] for name in MAIN}
    assert all(len(found) == 2 for found in by_method.values())
    ablations = {row["method"] for row in rows} - set(MAIN)
    assert (ablations > {"paper-no-region", "paper-lambda-1000"}) == bool(more)
    for matched, paper in zip(by_method["lean-at-paper-tilt"], by_method["paper"], strict=True):
        assert float(matched["mass"]) <= float(paper["mass"]) * (1 + 1e-7)
    written = {path: path.stat().st_mtime_ns for path in (out / "results").rglob("*.json")}
    assert len(written) == len(rows)
    table = (out / "table.csv").read_bytes()
    assert run([*arguments, "-q"]) == 0
    assert capsys.readouterr().out == ""
    assert (out / "table.csv").read_bytes() == table
    assert written == {path: path.stat().st_mtime_ns for path in written}


def test_json_is_all_there_is(models, tmp_path, capsys):
    arguments = ["evaluate", str(models), "-o", str(tmp_path / "out"), "--resolution", "12"]
    assert run([*arguments, "--methods", "shell, lean", "--lean", "5", "--json"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert said.err == ""
    assert list(found["methods"]) == ["shell", "lean"]
    assert {row["lean_deg"] for row in found["results"]} == {None, 5.0}


def test_a_bad_model_is_told_and_fails_the_run(models, tmp_path, capsys):
    (models / "broken.stl").write_text("not a mesh")
    arguments = ["evaluate", str(models), "-o", str(tmp_path / "out"), "--resolution", "8"]
    assert run([*arguments, "--methods", "solid", "-q"]) == 3
    assert "broken.stl" in capsys.readouterr().err
    assert len((tmp_path / "out" / "table.csv").read_text().splitlines()) == 3


@pytest.mark.parametrize(
    "more, code",
    [
        (["--methods", "best"], 2),
        (["--methods", ","], 2),
        (["--resolution", "0"], 2),
        (["--only", "nobody"], 2),
        (["--set", "dev"], 2),
        (["--up", "w"], 2),
        (["--workers", "0"], 2),
    ],
)
def test_what_cannot_be_meant(models, tmp_path, capsys, more, code):
    assert run(["evaluate", str(models), "-o", str(tmp_path / "out"), *more]) == code
    assert "printprep: error:" in capsys.readouterr().err
    assert not (tmp_path / "out" / "table.csv").exists()


def test_methods_named_for_speed_are_those_of_the_library():
    assert METHODS == MAIN
