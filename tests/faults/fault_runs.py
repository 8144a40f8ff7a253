"""Runs of the real command, disturbed from outside."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from printprep.children import _environment, _processes

PROGRAM = (sys.executable, "-m", "printprep")
MARK = "PRINTPREP_TEST_RUN"


def started(
    arguments: Sequence[str | Path], folder: Path, mark: str, **environment: str
) -> subprocess.Popen[str]:
    """The command, started in a folder; ``mark`` is in the environment of all its processes."""
    return subprocess.Popen(
        [*PROGRAM, *map(str, arguments)],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        encoding="utf-8",
        env={**os.environ, MARK: mark, "TMPDIR": str(folder), **environment},
    )


def done(
    arguments: Sequence[str | Path],
    folder: Path,
    *,
    environment: Mapping[str, str] | None = None,
    **options: object,
) -> subprocess.CompletedProcess[str]:
    """The command, run to its end."""
    return subprocess.run(
        [*PROGRAM, *map(str, arguments)],
        cwd=folder,
        capture_output="stdout" not in options and "stderr" not in options,
        encoding="utf-8",
        check=False,
        timeout=120,
        env={**os.environ, "TMPDIR": str(folder), **(environment or {})},
        **options,  # type: ignore[call-overload]
    )


def left(mark: str) -> list[int]:
    """The processes of a run that still live."""
    own = f"{MARK}={mark}".encode()
    return [process for process in _processes() if own in (_environment(process) or [])]


def ended(mark: str, within_s: float) -> bool:
    """Whether all processes of a run end within a time."""
    last = time.monotonic() + within_s
    while left(mark):
        if time.monotonic() > last:
            return False
        time.sleep(0.02)
    return True


def names(folder: Path) -> list[str]:
    """All files in a folder, hidden ones too."""
    return sorted(path.name for path in folder.iterdir())


def clear(stderr: str) -> bool:
    """Whether an error is told as it should be: one line and perhaps a hint, no traceback."""
    lines = stderr.splitlines()
    told = [line for line in lines if line.startswith("printprep: error: ")]
    hints = [line for line in lines if line.startswith("  ")]
    return len(told) == 1 and len(hints) <= 1 and len(told) + len(hints) == len(lines)


KILL, INTERRUPT, TERMINATE = signal.SIGKILL, signal.SIGINT, signal.SIGTERM
