"""`batch --reports`: a page beside every part, a summary that links to them, and --resume."""

from __future__ import annotations

import json

import pytest
from closed_form_parts import box
from page_reader import read

from printprep.cli.run import run
from printprep.mesh.write import to_bytes

pytestmark = pytest.mark.slow


@pytest.fixture
def models(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "in" / "a b").mkdir(parents=True)
    (tmp_path / "in" / "a b" / "cube.stl").write_bytes(to_bytes(box(12.0), ".stl"))
    (tmp_path / "in" / "bad.stl").write_bytes(b"no model")
    return tmp_path


def test_every_row_has_its_page(models, capsys):
    arguments = ["batch", "in", "-o", "out", "--reports", "--jobs", "1", "--resolution", "24"]
    assert run(arguments) == 1  # one of them is no model
    out = models / "out"
    assert (out / "a b" / "cube.html").read_bytes().startswith(b"<!doctype html>")
    rows = {row["output"]: row for row in json.loads((out / "summary.json").read_text())["rows"]}
    assert rows["a b/cube.3mf"]["report"] == "a b/cube.html"
    assert rows["bad.3mf"]["report"] is None
    found = read((out / "summary.html").read_bytes())
    assert [link.attributes["href"] for link in found.named("a")] == ["./a%20b/cube.html"]
    assert "bad.stl" in found.text
    capsys.readouterr()
    (out / "a b" / "cube.html").unlink()
    assert run([*arguments, "--resume"]) == 1
    assert (out / "a b" / "cube.html").is_file()


def test_reports_do_not_travel(models, capsys):
    assert run(["batch", "in", "-o", "out", "--reports", "--transfer"]) == 2
    assert "not reports" in capsys.readouterr().err
