"""Runs another program: with a time limit, bounded output, and an end to all that it started.

A slicer or a repair can hang, print without end, crash, or leave processes behind.  A child gets a
session of its own, which is ended as a whole; what left that session is known by a variable in its
environment (Linux).
"""

from __future__ import annotations

import contextlib
import os
import secrets
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO

HEAD_BYTES = 4 << 20  # of each stream that are kept; of the rest only the last
TAIL_BYTES = 1 << 16
FLOOD_BYTES = 64 << 20  # a child that prints more is ended
RUN_VARIABLE = "PRINTPREP_RUN"
SESSION_VARIABLE = "PRINTPREP_SESSION"

IDLE_S = 30.0  # a child whose processes all use no processor for so long hangs (Linux)

_POLL_S = 0.02
_LOOK_S = 1.0  # how often it is looked whether a child is at work
_READ_BYTES = 1 << 16
_MOST_LOOKS = 16  # for what a child left behind
_PIPE_END_S = 1.0  # how long a stream may stay open after all known processes ended


class HungError(Exception):
    """The child did not end in its time, or did nothing; it was ended.  The message says which."""


class FloodedError(Exception):
    """The child printed without end, and was ended."""


@dataclass(frozen=True)
class Ended:
    """A child that ended by itself.

    exit_code : negative for a signal;  stdout, stderr : their first 4 MiB and last 64 KiB.
    """

    exit_code: int
    stdout: str
    stderr: str


def run(
    command: Sequence[str], timeout_s: float, environment: Mapping[str, str] | None = None
) -> Ended:
    """Run a program with closed standard input, and wait for it; all it started is ended too.

    environment : variables to add.

    Raises OSError where it cannot be started, HungError, FloodedError.
    """
    token = secrets.token_hex(8)
    posix = os.name == "posix"
    process = subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env={**os.environ, **(environment or {}), RUN_VARIABLE: token},
        start_new_session=posix,
    )
    assert process.stdout is not None and process.stderr is not None  # both are pipes
    out, err = _Kept(process.stdout), _Kept(process.stderr)
    try:
        _wait(process, timeout_s, out, err)
    finally:
        if posix:
            with contextlib.suppress(ProcessLookupError, PermissionError):
                os.killpg(process.pid, signal.SIGKILL)
        process.kill()
        process.wait()
        end_marked(RUN_VARIABLE, token)
        out.close()
        err.close()
    return Ended(process.returncode, out.text(), err.text())


def _wait(process: subprocess.Popen[bytes], timeout_s: float, *streams: _Kept) -> None:
    """Wait for a process.  Raises HungError, FloodedError."""
    began = time.monotonic()
    at_work, spent, look = began, 0, began + _LOOK_S
    while True:
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(_POLL_S)
            return
        if any(stream.size > FLOOD_BYTES for stream in streams):
            raise FloodedError
        now = time.monotonic()
        if now > look:
            look = now + _LOOK_S
            more = _spent(process.pid)
            if more is None or more != spent:
                at_work, spent = now, more or 0
        if now - began > timeout_s:
            raise HungError(f"was stopped after {timeout_s:g} s without a result")
        if now - at_work > IDLE_S:
            raise HungError(f"was stopped: it did nothing for {IDLE_S:g} s")


class _Kept:
    """Reads a stream in a thread, and keeps its beginning and its end."""

    def __init__(self, stream: IO[bytes]) -> None:
        self.size = 0
        self._stream = stream
        self._head = bytearray()
        self._tail = bytearray()
        self._thread = threading.Thread(target=self._read, daemon=True)
        self._thread.start()

    def _read(self) -> None:
        with contextlib.suppress(OSError, ValueError):  # closed meanwhile
            while piece := os.read(self._stream.fileno(), _READ_BYTES):
                self.size += len(piece)
                room = max(0, HEAD_BYTES - len(self._head))
                self._head += piece[:room]
                self._tail += piece[room:]
                del self._tail[:-TAIL_BYTES]

    def close(self) -> None:
        """Wait for the end of the stream, which a process that nothing ends could hold open."""
        self._thread.join(_PIPE_END_S)
        if not self._thread.is_alive():
            self._stream.close()

    def text(self) -> str:
        return bytes(self._head + self._tail).decode("utf-8", "replace")


def _spent(child: int) -> int | None:
    """Processor time that a child took so far, with its session and all descendants, in ticks.

    None where the system does not tell.
    """
    if not sys.platform.startswith("linux"):
        return None
    parents: dict[int, int] = {}
    mine, ticks = {child}, {}
    for process in sorted(_processes()):
        with contextlib.suppress(OSError):
            # After the name, which may hold anything: state, parent, group, session, …
            fields = Path(f"/proc/{process}/stat").read_bytes().rpartition(b")")[2].split()
            parents[process] = int(fields[1])
            ticks[process] = sum(int(ticked) for ticked in fields[11:15])
            if int(fields[3]) == child:
                mine.add(process)
    while more := {each for each, parent in parents.items() if parent in mine} - mine:
        mine |= more
    return sum(ticks.get(process, 0) for process in mine)


def end_marked(variable: str, token: str) -> None:
    """End all processes that have a variable with this value in their environment (Linux only).

    One look sees no process that began after it, and an empty environment of one that is about to
    become another program.  So it looks again where one has gone meanwhile (its child may live on)
    or does not show its environment.
    """
    if not sys.platform.startswith("linux"):
        return
    mark = f"{variable}={token}".encode()
    for _ in range(_MOST_LOOKS):
        clear = True
        for process in _processes():
            environment = _environment(process)
            if environment is None:
                clear = False
            elif mark in environment:
                clear = False
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.kill(process, signal.SIGKILL)
        if clear:
            return
        time.sleep(_POLL_S)


def _processes() -> list[int]:
    own = os.getpid()
    return [
        int(entry.name)
        for entry in Path("/proc").iterdir()
        if entry.name.isdigit() and int(entry.name) != own
    ]


def _environment(process: int) -> list[bytes] | None:
    """The environment that a process started with; empty where it is another user's or ended.

    None where the process has gone, or runs a program and shows none.
    """
    folder = Path(f"/proc/{process}")
    with contextlib.suppress(OSError):
        if shown := (folder / "environ").read_bytes():
            return shown.split(b"\0")
        (folder / "exe").readlink()
        return None
    # Another user's, the kernel's own, and one that has ended but is not yet waited for.
    return [] if folder.exists() else None
