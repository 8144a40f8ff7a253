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
from typing import NoReturn

from printprep.cli.signals import Terminated

GRACE_S = 0.6  # for a command to end by itself after a signal
_SIGNALS = tuple(
    getattr(signal, name) for name in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, name)
)


def supervised(arguments: Sequence[str] | None) -> NoReturn:
    """Run the command line, and exit with its exit code."""
    if sys.platform != "linux":
        _work(arguments)
    parent = os.getpid()
    heard: list[int] = []
    _on_signals(lambda number, _frame: heard.append(number))  # until both know what to do
    token = os.urandom(8).hex()
    told, tell = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(told)
        _end_with(parent)
        from printprep.children import SESSION_VARIABLE

        os.environ[SESSION_VARIABLE] = token
        _work(arguments, heard, tell)
    os.close(tell)
    _wait_for(child, token, told, heard, sys.argv[1:] if arguments is None else arguments)


def _work(
    arguments: Sequence[str] | None, heard: Sequence[int] = (), tell: int | None = None
) -> NoReturn:
    """Run the command line in this process, and exit.

    heard : signals that came before this;  tell : where a byte is written before it ends in order.
    """
    try:
        try:
            sys.unraisablehook = _not_lost
            _on_signals(_stop)
            if heard:
                _stop(heard[0], None)
            from printprep.cli.run import main

            main(arguments)
        finally:
            _ignore_signals()  # it has ended: what comes now, comes too late
    except SystemExit:
        _tell(tell)
        raise
    except Terminated as error:
        number = error.number
    else:
        _tell(tell)
        sys.exit(0)
    # The report is short, and what the run held is put away: the interpreter need not be ended.
    _tell(tell)
    from printprep.cli.run import report_signal

    code = report_signal(number, sys.argv[1:] if arguments is None else arguments)
    with contextlib.suppress(Exception):
        sys.stdout.flush()
        sys.stderr.flush()
    os._exit(code)


def _tell(pipe: int | None) -> None:
    """Write the byte that says that this process ends in order."""
    if pipe is not None:
        with contextlib.suppress(BrokenPipeError):  # the one who waits was killed
            os.write(pipe, b".")


def _not_lost(unraisable: sys.UnraisableHookArgs) -> None:
    """Where a signal came in a callback, which can pass no error on, let it come again."""
    if isinstance(unraisable.exc_value, Terminated) and hasattr(signal, "setitimer"):
        _come_again(unraisable.exc_value.number)
    else:
        sys.__unraisablehook__(unraisable)


def _stop(number: int, frame: FrameType | None) -> None:
    """End the run once: while it ends, further signals do not disturb it."""
    _ignore_signals()
    if hasattr(signal, "setitimer") and _imports(frame):
        _come_again(number)
    else:
        raise Terminated(number)


def _ignore_signals() -> None:
    """Ignore the signals that end a program, and one that was to come again."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, 0)
    for each in _SIGNALS:
        signal.signal(each, signal.SIG_IGN)


def _come_again(number: int) -> None:
    """Let a signal come again in a moment."""
    signal.signal(signal.SIGALRM, lambda _number, frame: _stop(number, frame))
    signal.setitimer(signal.ITIMER_REAL, 0.01)


def _imports(frame: FrameType | None) -> bool:
    """Whether a module is being loaded: native ones end the process if their loading raises."""
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


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


def _wait_for(
    child: int, token: str, told: int, heard: list[int], arguments: Sequence[str]
) -> NoReturn:
    """Wait for the command, pass signals on to it, and exit as it did.

    told : where a byte comes from it before it ends in order.
    """
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
    # Until it is reaped, its number is no other process's: a signal passed on reaches it or nobody.
    os.waitid(os.P_PID, child, os.WEXITED | os.WNOWAIT)
    ended = True
    _, status = os.waitpid(child, 0)
    signal.setitimer(signal.ITIMER_REAL, 0)
    code = os.waitstatus_to_exitcode(status)
    if code < 0 or heard:
        _remove_rests(child, token)
    in_order = _has_byte(told)
    if code >= 0 and in_order:
        os._exit(code)
    from printprep.cli.run import report_crash, report_signal
    from printprep.cli.streams import guard_streams

    guard_streams()
    if not heard:
        os._exit(report_crash(code, arguments))
    os._exit(128 + heard[0] if in_order else report_signal(heard[0], arguments))


def _has_byte(pipe: int) -> bool:
    os.set_blocking(pipe, False)
    try:
        return bool(os.read(pipe, 1))
    except BlockingIOError:  # another process still holds its other end
        return False


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
