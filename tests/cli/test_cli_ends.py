"""Every way a run can end: one clear line or one JSON object, and the exit code of its kind."""

from __future__ import annotations

import json
import subprocess
import sys

import pytest

from printprep import errors
from printprep.cli.run import run

ENDS = [
    (errors.UsageError, 2, "usage"),
    (errors.InputError, 3, "input"),
    (errors.GeometryError, 4, "geometry"),
    (errors.OutputError, 5, "output"),
    (errors.ToolError, 6, "tool"),
]


@pytest.fixture
def ends_with(monkeypatch, tmp_path):
    """Make the method end with an exception."""
    monkeypatch.chdir(tmp_path)

    def arrange(error: BaseException) -> None:
        def hollow(*args, **kwargs):
            raise error

        monkeypatch.setattr("printprep.pipeline.hollow.hollow_with", hollow)

    return arrange


@pytest.mark.parametrize(("family", "exit_code", "code"), ENDS)
def test_each_family_has_its_code(ends_with, capsys, family, exit_code, code):
    ends_with(family("m.stl is\nnot it.", "Try another."))
    assert run(["hollow", "m.stl"]) == exit_code
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err == "printprep: error: m.stl is not it.\n  Try another.\n"


@pytest.mark.parametrize(("family", "exit_code", "code"), ENDS)
def test_and_its_json(ends_with, capsys, family, exit_code, code):
    ends_with(family("No.", None))
    assert run(["hollow", "m.stl", "--json"]) == exit_code
    captured = capsys.readouterr()
    assert json.loads(captured.out) == {"error": {"code": code, "message": "No.", "hint": None}}
    assert captured.err == ""


def test_a_defect_is_a_sentence_and_a_traceback_only_when_asked_for(ends_with, capsys):
    ends_with(ZeroDivisionError("division by zero"))
    assert run(["hollow", "m.stl"]) == 70
    err = capsys.readouterr().err
    assert "defect of printprep: ZeroDivisionError: division by zero" in err
    assert "Traceback" not in err
    assert run(["hollow", "m.stl", "-v"]) == 70
    assert "Traceback" in capsys.readouterr().err


def test_a_defect_in_json(ends_with, capsys):
    ends_with(KeyError())
    assert run(["hollow", "m.stl", "--json", "-qv"]) == 70
    captured = capsys.readouterr()
    assert json.loads(captured.out)["error"]["code"] == "defect"
    assert "Traceback" in captured.err


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_an_interrupt(ends_with, capsys, form):
    ends_with(KeyboardInterrupt())
    assert run(["hollow", "m.stl", *form]) == 130
    captured = capsys.readouterr()
    if form:
        assert json.loads(captured.out)["error"]["code"] == "interrupted"
    else:
        assert captured.err.strip() == "printprep: error: Interrupted."


@pytest.mark.parametrize(
    "line",
    [
        "hollow", "hollow m.stl --nope", "hollow m.stl --size tall", "hollow a b", "holow m.stl",
        "hollow m.stl --base maybe", "profiles show", "check",
    ],
)  # fmt: skip
def test_what_cannot_be_parsed_is_usage(capsys, line):
    assert run(line.split()) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("printprep: error: ")
    assert "--help` shows the usage" in captured.err


def test_what_cannot_be_parsed_is_json_too(capsys):
    assert run(["hollow", "m.stl", "--nope", "--json"]) == 2
    error = json.loads(capsys.readouterr().out)["error"]
    assert error["code"] == "usage"
    assert "--nope" in error["message"]


def test_behind_a_double_dash_nothing_is_an_option(ends_with, capsys):
    ends_with(errors.InputError("gone"))
    assert run(["hollow", "-q", "--", "--json"]) == 3
    assert capsys.readouterr().err == "printprep: error: gone\n"


def test_the_installed_way_in_leaves_with_the_code():
    done = subprocess.run(
        [sys.executable, "-m", "printprep", "hollow", "no-such-file.stl", "--json"],
        capture_output=True, encoding="utf-8", check=False,
    )  # fmt: skip
    assert done.returncode == 3
    assert json.loads(done.stdout)["error"]["code"] == "input"
    assert "Traceback" not in done.stderr


def test_a_pipe_in_a_code_page_does_not_break():
    done = subprocess.run(
        [sys.executable, "-m", "printprep", "profiles", "export", "resin-standard"],
        capture_output=True, check=False, env={"PYTHONIOENCODING": "ascii", "PATH": ""},
    )  # fmt: skip
    listed = subprocess.run(
        [sys.executable, "-m", "printprep", "profiles"],
        capture_output=True, check=False, env={"PYTHONIOENCODING": "ascii", "PATH": ""},
    )  # fmt: skip
    assert (done.returncode, listed.returncode) == (2, 0)
    assert b"250 ? 210 ? 210" in listed.stdout
