"""The commands that write pages: what they write, what they refuse, and with which exit code."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from closed_form_parts import box, hollow_result
from page_reader import read, view_of

from printprep.cli.run import run
from printprep.mesh.write import to_bytes


@pytest.fixture
def here(tmp_path, monkeypatch) -> Path:
    """A folder with a cube of 12 mm, and a part that printprep wrote."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cube.stl").write_bytes(to_bytes(box(12.0), ".stl"))
    hollow_result(with_base=True).write(tmp_path / "part.3mf")
    return tmp_path


def refused(capsys, *arguments: str) -> tuple[int, str]:
    code = run(list(arguments))
    return code, capsys.readouterr().err


def test_a_page_of_a_written_part(here, capsys):
    assert run(["report", "part.3mf"]) == 0
    assert capsys.readouterr().out == "Written: part.html\n"
    page = (here / "part.html").read_bytes()
    found, view = read(page), view_of(page)
    assert found.by_id("kicker").text == "Hollowed for PLA, fdm-pla-0.4"
    assert "printprep report part.3mf" in found.text
    # The solid is 20 mm tall: its centre of mass is half way up, but for the base
    assert view["balance"]["centreBefore"][2] == pytest.approx(9.795, abs=2e-3)
    assert view["balance"]["centre"][2] == pytest.approx(
        (10 * 3904 + 0.5 * 176) / (3904 + 176), abs=2e-3
    )
    assert view["low"] == [-12.0, -12.0, 0.0] and view["high"] == [12.0, 12.0, 20.0]
    first = page
    assert run(["report", "part.3mf", "-q"]) == 0
    # The command line is on the page
    assert (here / "part.html").read_bytes() == first.replace(
        b"report part.3mf<", b"report part.3mf -q<"
    )


@pytest.mark.parametrize(
    ("arguments", "code", "said"),
    [
        (["report", "none.3mf"], 3, "none.3mf does not exist"),
        (["report", "cube.stl"], 3, "cube.stl"),
        (["report", "part.3mf", "-o", "part.pdf"], 2, "writes only .html"),
        (["report", "part.3mf", "-o", "no/part.html"], 5, "no does not exist"),
        (["report", "part.3mf", "--compare", "cube.stl"], 2, "--compare has no effect"),
        (["hollow", "cube.stl", "--report", "out.txt"], 2, "--report writes only .html"),
        (["hollow", "cube.stl", "--report", "no/out.html"], 5, "no does not exist"),
        (
            ["hollow", "cube.stl", "--plugs", "p.3mf", "-p", "resin-standard", "--report", "."],
            2,
            ".",
        ),
        (["view", "none.stl", "-o", "a.html"], 3, "none.stl does not exist"),
        (["view", "cube.stl", "-o", "a.txt"], 2, "writes only .html"),
        (["view", "cube.stl", "--serve", "-o", "a.html"], 2, "--serve writes no page"),
        (["view", "cube.stl", "--port", "8000"], 2, "--port has no effect"),
        (["view", "cube.stl", "--no-browser"], 2, "a page that no one sees"),
    ],
)
def test_what_cannot_be_is_refused_before_the_work(here, capsys, arguments, code, said):
    before = sorted(here.iterdir())
    assert refused(capsys, *arguments)[0] == code
    assert said in refused(capsys, *arguments)[1]
    assert sorted(here.iterdir()) == before


@pytest.mark.slow
def test_a_page_of_a_model(here, capsys):
    assert run(["view", "cube.stl", "-o", "cube.html", "--no-browser"]) == 0
    page = (here / "cube.html").read_bytes()
    found, view = read(page), view_of(page)
    assert not view["hollowed"] and view["balance"]["tiltDeg"] == pytest.approx(45.0, abs=0.01)
    # A cube stands on each of its faces
    assert [round(pose["tiltDeg"], 3) for pose in view["poses"]] == [45.0] * 6
    assert "Stable poses" in found.text and "12 × 12 × 12 mm" in found.text


@pytest.mark.slow
def test_view_opens_the_browser(here, monkeypatch, capsys):
    opened = []
    monkeypatch.setattr("webbrowser.open", opened.append)
    assert run(["view", "cube.stl", "-q"]) == 0
    (url,) = opened
    assert url.startswith("file://") and url.endswith("/cube.html")
    assert Path(url.removeprefix("file://")).read_bytes().startswith(b"<!doctype html>")
    assert capsys.readouterr().out == ""


@pytest.mark.slow
def test_hollow_writes_a_page_beside_its_part(here, capsys):
    arguments = [
        "hollow",
        "cube.stl",
        "-o",
        "out.3mf",
        "--report",
        "out.html",
        "--resolution",
        "24",
    ]
    assert run([*arguments, "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["report"] == "out.html"
    page = (here / "out.html").read_bytes()
    assert "printprep hollow cube.stl -o out.3mf" in read(page).text
    assert "What each degree of lean costs" in read(page).text
    assert run(arguments) == 0
    assert "The page about it: out.html" in capsys.readouterr().out
    # The command line is on the page, and this one has no --json
    assert (here / "out.html").read_bytes() == page.replace(b" --json", b"")


@pytest.mark.slow
def test_a_part_that_is_stopped_has_its_page(here):
    """The page shows why the part was not written."""
    arguments = ["hollow", "cube.stl", "-o", "out.3mf", "--report", "out.html", "--lean", "59"]
    assert run([*arguments, "--base", "never", "--fail-on", "error", "--resolution", "24"]) == 1
    assert not (here / "out.3mf").exists()
    assert "lean-out-of-reach" in read((here / "out.html").read_bytes()).text
