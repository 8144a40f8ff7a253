"""``printprep profiles``: list, show, export."""

from __future__ import annotations

import json
import tomllib
from pathlib import Path

import pytest

from printprep.cli.run import run
from printprep.profiles import profile_names, profile_source


@pytest.mark.parametrize("line", ["profiles", "profiles list"])
def test_list_names_all_within_80_columns(capsys, line):
    assert run(line.split()) == 0
    out = capsys.readouterr().out
    assert [row.split()[0] for row in out.splitlines()[1 : 1 + len(profile_names())]] == list(
        profile_names()
    )
    assert max(map(len, out.splitlines())) <= 80
    assert "…" not in out


@pytest.mark.parametrize("line", ["profiles --json", "profiles list --json"])
def test_list_as_json(capsys, line):
    assert run(line.split()) == 0
    data = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in data["profiles"]] == list(profile_names())


def test_an_option_in_the_wrong_place_is_not_ignored(capsys):
    assert run(["profiles", "--json", "show", "fdm-pla-0.4"]) == 2
    error = json.loads(capsys.readouterr().out)["error"]
    assert "printprep profiles show --json" in error["message"]


def test_show_gives_the_toml_with_its_comments(capsys):
    assert run(["profiles", "show", "fdm-pla-0.4"]) == 0
    out = capsys.readouterr().out
    assert tomllib.loads(out)["wall_mm"] == 1.2
    assert "#" in out


def test_show_as_json(capsys):
    assert run(["profiles", "show", "sls-pa12", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert (data["name"], data["process"]) == ("sls-pa12", "powder")


def test_show_takes_a_path_and_judges_it(tmp_path, capsys):
    path = tmp_path / "mine.toml"
    assert run(["profiles", "show", "fdm-pla-0.4"]) == 0
    good = capsys.readouterr().out
    path.write_text(good, encoding="utf-8")
    assert run(["profiles", "show", str(path)]) == 0
    assert capsys.readouterr().out == good
    path.write_text(good.replace("wall_mm = 1.2", "wall_mm = -1"), encoding="utf-8")
    assert run(["profiles", "show", str(path)]) == 2
    assert "wall_mm" in capsys.readouterr().err


def test_export_to_stdout_and_to_a_file(tmp_path, capsys):
    assert run(["profiles", "export", "fdm-pla-0.4"]) == 0
    text = capsys.readouterr().out
    assert "first_layer_height = 0.2\n" in text
    target = tmp_path / "mine.ini"
    line = ["profiles", "export", "fdm-pla-0.4", "--set", "printer.first_layer_mm=0.3"]
    assert run([*line, "-o", str(target)]) == 0
    assert "first_layer_height = 0.3\n" in target.read_text(encoding="utf-8")
    assert "Written:" in capsys.readouterr().out


def test_export_does_not_replace_the_profile_itself(tmp_path, capsys):
    own, link = tmp_path / "own.toml", tmp_path / "link.ini"
    own.write_text(profile_source("fdm-pla-0.4"))
    link.symlink_to(own)
    for output in (own, link):
        assert run(["profiles", "export", str(own), "-o", str(output)]) == 2
        assert "is the profile" in capsys.readouterr().err
        assert own.read_text() == profile_source("fdm-pla-0.4")


def test_export_into_a_missing_folder(capsys):
    assert run(["profiles", "export", "fdm-pla-0.4", "-o", str(Path("nowhere") / "x.ini")]) == 5


def test_unknown_names_are_met_with_what_there_is(capsys):
    assert run(["profiles", "show", "fdm-pla"]) == 2
    assert "Did you mean fdm-pla-0." in capsys.readouterr().err
