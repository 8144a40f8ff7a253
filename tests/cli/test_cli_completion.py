"""Completion in a shell: the scripts, what printprep answers them, and a real bash."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import click
import pytest
from click.shell_completion import ShellComplete

from printprep.cli.app import printprep
from printprep.cli.run import run
from printprep.profile_folders import profile_names

SHELLS = ("bash", "zsh", "fish")


def completed(*words: str) -> list[str]:
    """What the last of the words is completed to; files as "file"."""
    answer = ShellComplete(printprep, {}, "printprep", "_X")
    *before, last = words
    found = answer.get_completions(before, last)
    return [item.value if item.type == "plain" else item.type for item in found]


def script(shell: str, capsys) -> str:
    assert run(["completion", shell]) == 0
    return capsys.readouterr().out


@pytest.mark.parametrize("shell", SHELLS)
def test_each_shell_has_a_script_that_asks_printprep(shell, capsys):
    text = script(shell, capsys)
    assert f"_PRINTPREP_COMPLETE={shell}_complete" in text
    assert "printprep" in text


@pytest.mark.parametrize("shell", SHELLS)
def test_the_shell_itself_reads_its_script(shell, shell_program, capsys, tmp_path):
    program = shell_program(shell)
    path = tmp_path / "script"
    path.write_text(script(shell, capsys), encoding="utf-8")
    done = subprocess.run([program, "-n", str(path)], capture_output=True, encoding="utf-8")
    assert (done.returncode, done.stderr) == (0, "")


def test_another_shell_is_a_usage_error(capsys):
    assert run(["completion", "tcsh"]) == 2
    assert "'bash', 'zsh', 'fish'" in capsys.readouterr().err


def test_commands_and_options():
    assert completed("") == printprep.list_commands(click.Context(printprep))
    assert completed("ho") == ["hollow", "hook"]
    assert completed("profiles", "e") == ["export"]
    assert completed("hollow", "--dry") == ["--dry-run"]
    assert completed("hollow", "--fill", "") == ["cavity", "infill"]
    assert completed("hollow", "mo") == ["file"]
    assert completed("hollow", "-o", "") == ["file"]


@pytest.mark.parametrize(
    "before",
    [
        ("hollow", "--profile"), ("check", "--profile"), ("batch", "-p"), ("view", "-p"),
        ("explore", "--profile"), ("simulate", "--profile"), ("hook", "--profile"),
        ("profiles", "new", "mine", "--from"), ("profiles", "import", "x", "mine", "--from"),
        ("profiles", "show"), ("profiles", "export"),
    ],
    ids=" ".join,
)  # fmt: skip
def test_profiles_are_completed_wherever_one_is_named(before, tmp_path, monkeypatch):
    monkeypatch.setenv("PRINTPREP_PROFILES", str(tmp_path))
    (tmp_path / "resin-mine.toml").touch()
    assert completed(*before, "") == ["file", *profile_names(), "resin-mine"]
    assert completed(*before, "resin-m") == ["file", "resin-msla-mono", "resin-mine"]


def test_every_option_that_names_a_profile_completes_it():
    """Of all commands, so that a new one does not forget it."""

    def parameters(command: click.Command, context: click.Context):
        yield from command.params
        if isinstance(command, click.Group):
            for name in command.list_commands(context):
                child = command.get_command(context, name)
                assert child is not None
                yield from parameters(child, click.Context(child, context))

    named = [
        item
        for item in parameters(printprep, click.Context(printprep))
        if item.metavar == "NAME|FILE"
    ]
    assert len(named) >= 9
    assert all(item._custom_shell_complete is not None for item in named)


@pytest.mark.parametrize(
    ("shell", "environment"),
    [
        ("bash", {"COMP_WORDS": "printprep hollow -p fdm-pe", "COMP_CWORD": "3"}),
        ("zsh", {"COMP_WORDS": "printprep hollow -p fdm-pe", "COMP_CWORD": "3"}),
        ("fish", {"COMP_WORDS": "printprep hollow -p ", "COMP_CWORD": "fdm-pe"}),
    ],
)
def test_the_program_answers_the_script(shell, environment):
    done = subprocess.run(
        [sys.executable, "-m", "printprep"], capture_output=True, encoding="utf-8",
        env={**os.environ, **environment, "_PRINTPREP_COMPLETE": f"{shell}_complete"},
    )  # fmt: skip
    assert done.stderr == ""
    assert done.returncode == 0
    assert "fdm-petg-0.4" in done.stdout
    assert "fdm-pla" not in done.stdout


LINE = {
    "bash": 'source "$SCRIPT"; COMP_WORDS=(printprep profiles show resin-m); COMP_CWORD=3; '
    '_printprep_completion printprep resin-m show; printf "%s\\n" "${COMPREPLY[@]}"',
    "fish": 'source "$SCRIPT"; complete -C "printprep profiles show resin-m"',
}


@pytest.mark.parametrize("shell", LINE)
def test_a_real_shell_completes(shell, shell_program, tmp_path, capsys):
    found = shell_program(shell)
    (tmp_path / "script").write_text(script(shell, capsys), encoding="utf-8")
    program = tmp_path / "printprep"
    program.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m printprep "$@"\n', encoding="utf-8")
    program.chmod(0o755)
    path = os.pathsep.join((str(tmp_path), os.environ["PATH"]))
    quiet = "--norc" if shell == "bash" else "--no-config"
    done = subprocess.run(
        [found, quiet, "-c", LINE[shell]], capture_output=True, encoding="utf-8",
        env={**os.environ, "PATH": path, "SCRIPT": str(tmp_path / "script")},
        cwd=Path(__file__).parents[2],
    )  # fmt: skip
    assert done.stdout.split() == ["resin-msla-mono"]
