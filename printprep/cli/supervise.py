"""Runs a command in a child process, and ends it in order whatever happens.

A library's native code can hold the interpreter for seconds: then no Python code hears Ctrl-C.  It
can crash, or be killed for the memory it takes.  So on Linux this process does nothing but wait: it
passes signals on, ends the command where that does not end by itself within a moment, removes
what it left, and tells how it ended.  Elsewhere the command runs in this process.

A run that a signal ends has the exit code 128 + its number, as in a shell: 130 for Ctrl-C.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
from collections.abc import Sequence
from types import FrameType

GRACE_S = 0.6  # for a command to end by itself after a signal
_SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)
_MEMORY_SIGNALS = (signal.SIGABRT, signal.SIGSEGV)


class Terminated(BaseException):
    """A signal that ends the program, other than Ctrl-C; ``exit_code`` is 128 + its number."""

    def __init__(self, number: int) -> None:
        super().__init__(number)
        self.exit_code = 128 + number


def supervised(arguments: Sequence[str] | None) -> None:
    """Run the command line, and exit with its exit code."""
    if sys.platform != "linux":
        _work(arguments)
    parent = os.getpid()
    heard: list[int] = []
    _on_signals(lambda number, _frame: heard.append(number))  # until both know what to do
    token = os.urandom(8).hex()
    child = os.fork()
    if child == 0:
        _end_with(parent)
        from printprep.children import SESSION_VARIABLE

        os.environ[SESSION_VARIABLE] = token
        _work(arguments, heard)
    _wait_for(child, token, heard, sys.argv[1:] if arguments is None else arguments)


def _work(arguments: Sequence[str] | None, heard: Sequence[int] = ()) -> None:
    """Run the command line in this process.  heard : signals that came before this."""
    code = 0
    try:
        _on_signals(_stop)
        if heard:
            _stop(heard[0], None)
        from printprep.cli.run import main

        main(arguments)
    except KeyboardInterrupt:
        code = _interrupted(signal.SIGINT)
    except Terminated as error:
        code = _interrupted(error.exit_code - 128)
    sys.exit(code)


def _interrupted(number: int) -> int:
    """Say on stderr that a signal ended a run that had not begun, and return its exit code."""
    with contextlib.suppress(OSError):
        os.write(2, f"printprep: error: {sentence_of(number)}\n".encode())
    return 128 + number


def sentence_of(number: int) -> str:
    """How a run that a signal ended is told."""
    if number == signal.SIGINT:
        return "Interrupted."
    return f"Ended by {signal.Signals(number).name}."


def _stop(number: int, _frame: FrameType | None) -> None:
    """End the run once: while it ends, further signals do not disturb it."""
    for each in _SIGNALS:
        signal.signal(each, signal.SIG_IGN)
    if number == signal.SIGINT:
        raise KeyboardInterrupt
    raise Terminated(number)


def _on_signals(handler: object) -> None:
    """Set the handler of the signals that end a program; one that is ignored (nohup) stays so."""
    for each in _SIGNALS:
        if signal.getsignal(each) is not signal.SIG_IGN:
            signal.signal(each, handler)  # type: ignore[arg-type]


def _end_with(parent: int) -> None:
    """Let this process get SIGTERM when its parent ends, however that happens (Linux)."""
    import ctypes

    set_signal_at_parents_death = 1  # PR_SET_PDEATHSIG, linux/prctl.h
    ctypes.CDLL(None).prctl(set_signal_at_parents_death, signal.SIGTERM, 0, 0, 0)
    if os.getppid() != parent:  # it ended before
        os.kill(os.getpid(), signal.SIGTERM)


def _wait_for(child: int, token: str, heard: list[int], arguments: Sequence[str]) -> None:
    """Wait for the command, pass signals on to it, and exit as it did."""
    ended = False

    def pass_on(number: int, _frame: FrameType | None) -> None:
        if not ended and not heard:
            heard.append(number)
            os.kill(child, number)
            signal.setitimer(signal.ITIMER_REAL, GRACE_S)

    def too_late(_number: int, _frame: FrameType | None) -> None:
        if not ended:
            os.kill(child, signal.SIGKILL)

    signal.signal(signal.SIGALRM, too_late)
    early, heard = list(heard), []
    _on_signals(pass_on)
    if early:
        pass_on(early[0], None)
    _, status = os.waitpid(child, 0)
    ended = True
    signal.setitimer(signal.ITIMER_REAL, 0)
    code = os.waitstatus_to_exitcode(status)
    if code < 0 or heard:
        _remove_rests(child, token)
    if code >= 0:
        os._exit(code)
    number = heard[0] if heard else -code
    os._exit(_told(number, by_request=bool(heard), arguments=arguments))


def _remove_rests(child: int, token: str) -> None:
    """End the programs that a command started, and remove its temporary files."""
    import shutil
    import tempfile
    from pathlib import Path

    from printprep.children import SESSION_VARIABLE, end_marked
    from printprep.files import scratch_prefix

    end_marked(SESSION_VARIABLE, token)
    with contextlib.suppress(OSError):
        for folder in Path(tempfile.gettempdir()).glob(f"{scratch_prefix(child)}*"):
            shutil.rmtree(folder, ignore_errors=True)


def _told(number: int, *, by_request: bool, arguments: Sequence[str]) -> int:
    """Tell how a command ended that could not tell it itself; return the exit code."""
    from printprep.cli.run import report_crash, report_signal

    return (report_signal if by_request else report_crash)(number, arguments)
