"""Runs a slicer once: with closed standard input, a time limit and a settings folder of its own.

So no question on standard input, no settings of the user and no command in a config changes what
the slicer does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from printprep.children import FLOOD_BYTES, FloodedError, HungError, run
from printprep.errors import ToolError
from printprep.files import reason_of
from printprep.wording import printable

SLICER_VARIABLE = "PRINTPREP_SLICER"
INSTALL_HINT = (
    "Install PrusaSlicer (Debian and Ubuntu: apt install prusa-slicer; elsewhere prusa3d.com), "
    f"or name the program with --slicer or {SLICER_VARIABLE}."
)
_QUOTED = 4096
_LINE = 300


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

    Raises ToolError where it cannot be started, runs beyond the time limit or prints without end
    (it is stopped then), or exits with a code other than 0.  Every process that it started is
    stopped with it.
    """
    own = folder / "datadir"
    own.mkdir(exist_ok=True)
    command = [str(executable), "--datadir", str(own), "--post-process", "", *arguments]
    try:
        ended = run(command, timeout_seconds, {"LC_ALL": "C"})  # decimal points in its output
    except OSError as error:
        raise ToolError(
            f"{executable} cannot be started: {reason_of(error)}.", INSTALL_HINT
        ) from error
    except HungError as error:
        raise ToolError(
            f"{executable.name} {error}.",
            "Slice the file by hand once, to see whether the slicer hangs on it.",
        ) from error
    except FloodedError as error:
        raise ToolError(
            f"{executable.name} was stopped: it printed more than {FLOOD_BYTES >> 20} MiB of "
            "messages.",
            "Slice the file by hand once, to see the slicer's messages.",
        ) from error
    done = RunOutput(ended.exit_code, ended.stdout, ended.stderr)
    if done.exit_code < 0:
        raise ToolError(
            f"{executable.name} crashed (signal {-done.exit_code}).", last_lines(done) or None
        )
    if done.exit_code != 0:
        raise ToolError(
            f"{executable.name} failed with exit code {done.exit_code}.", last_lines(done) or None
        )
    return done


def last_lines(done: RunOutput) -> str:
    """The last lines of a program's output, joined into one, to quote in an error."""
    text = f"{done.stdout[-_QUOTED:]}\n{done.stderr[-_QUOTED:]}"
    lines = [printable(line[-_LINE:]).strip() for line in text.splitlines()]
    return " / ".join([line for line in lines if line and "[trace]" not in line][-3:])
