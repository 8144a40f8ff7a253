"""One run of an outside program: closed standard input, a time limit, a settings folder of its own.

A question on standard input, a set-up of the user's or a hook in a config can change what a slicer
does; none of them reaches a run from here.
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
    "install PrusaSlicer (Debian and Ubuntu: apt install prusa-slicer; elsewhere prusa3d.com), "
    f"or name the program with --slicer or {SLICER_VARIABLE}"
)


@dataclass(frozen=True)
class Done:
    """How a program ended and what it said."""

    exit_code: int
    stdout: str
    stderr: str


def run_child(
    executable: Path, arguments: Sequence[str], folder: Path, timeout_seconds: float
) -> Done:
    """Run `executable`, its settings kept in `folder`, and wait for it.

    Raises ToolError where it cannot be started, outlasts the limit (it is ended then, with all it
    started), or exits with anything but 0.
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
            env={**os.environ, "LC_ALL": "C"},  # decimal points in what it prints
            start_new_session=posix,  # it may be a launcher: the whole group ends with it
        )
    except OSError as error:
        raise ToolError(f"{executable}: cannot be started ({error})", INSTALL_HINT) from error
    try:
        out, err = process.communicate(timeout=timeout_seconds)
    except subprocess.TimeoutExpired as error:
        raise ToolError(
            f"{executable.name} was ended after {timeout_seconds:g} s without a result"
        ) from error
    finally:
        _end(process, posix)
    done = Done(process.returncode, out, err)
    if done.exit_code != 0:
        raise ToolError(
            f"{executable.name} failed with exit code {done.exit_code}", last_lines(done) or None
        )
    return done


def _end(process: subprocess.Popen[str], posix: bool) -> None:
    """End a process that is still there, with what it started, and collect it."""
    if process.poll() is None:
        if posix:
            import signal

            os.killpg(process.pid, signal.SIGKILL)
        else:
            process.kill()
        process.communicate()


def last_lines(done: Done) -> str:
    """The end of what a program said, on one line, to quote in an error."""
    lines = [line.strip() for line in (f"{done.stdout}\n{done.stderr}").splitlines()]
    return " / ".join([line for line in lines if line and "[trace]" not in line][-3:])
