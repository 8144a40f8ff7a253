"""Runs a slicer once: with closed standard input, a time limit and a settings folder of its own.

So no question on standard input, no settings of the user and no command in a config changes what
the slicer does.
"""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from printprep.errors import ToolError

SLICER_VARIABLE = "PRINTPREP_SLICER"
INSTALL_HINT = (
    "Install PrusaSlicer (Debian and Ubuntu: apt install prusa-slicer; elsewhere prusa3d.com), "
    f"or name the program with --slicer or {SLICER_VARIABLE}."
)


@dataclass(frozen=True)
class RunOutput:
    """The exit code and the output of a program."""

    exit_code: int
    stdout: str
    stderr: str


def run_child(
    executable: Path, arguments: Sequence[str], folder: Path, timeout_seconds: float
) -> RunOutput:
    """Run `executable`, with its settings in `folder`, and wait for it.

    Raises ToolError where it cannot be started, runs beyond the time limit (it is stopped then,
    with every process it started), or exits with a code other than 0.
    """
    own = folder / "datadir"
    own.mkdir(exist_ok=True)
    command = [str(executable), "--datadir", str(own), "--post-process", "", *arguments]
    posix = os.name == "posix"
    try:
        process = subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            encoding="utf-8",
            errors="replace",
            env={**os.environ, "LC_ALL": "C"},  # decimal points in its output
            start_new_session=posix,  # it may be a launcher: the whole group is stopped with it
        )
    except OSError as error:
        raise ToolError(f"{executable} cannot be started: {error}.", INSTALL_HINT) from error
    try:
        out, err = process.communicate(timeout=timeout_seconds)
    except subprocess.TimeoutExpired as error:
        raise ToolError(
            f"{executable.name} was stopped after {timeout_seconds:g} s without a result."
        ) from error
    finally:
        _end(process, posix)
    done = RunOutput(process.returncode, out, err)
    if done.exit_code != 0:
        raise ToolError(
            f"{executable.name} failed with exit code {done.exit_code}.", last_lines(done) or None
        )
    return done


def _end(process: subprocess.Popen[str], posix: bool) -> None:
    """Stop a process that still runs, with every process it started, and wait for its end."""
    if process.poll() is None:
        if posix:
            import signal

            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.communicate()


def last_lines(done: RunOutput) -> str:
    """The last lines of a program's output, joined into one, to quote in an error."""
    lines = [line.strip() for line in (f"{done.stdout}\n{done.stderr}").splitlines()]
    return " / ".join([line for line in lines if line and "[trace]" not in line][-3:])
