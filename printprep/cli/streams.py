"""Standard output and error of the program: what cannot be written ends the run in order.

A reader of standard output can go away, and its device can be full: that is an OutputError, told
once on stderr.  What stderr cannot take is dropped.  A stream that is closed at the start is opened
on the null device, or the next file that is opened would become that stream.
"""

from __future__ import annotations

import errno
import io
import os
import sys
from typing import TextIO

from printprep.errors import OutputError
from printprep.files import reason_of


class StreamError(OutputError):
    """Standard output cannot be written: that is told on stderr, whatever form was asked for."""


class _Raw(io.RawIOBase):
    """A file descriptor that is written to until it fails, and swallows everything afterwards."""

    def __init__(self, descriptor: int, name: str | None) -> None:
        """name : how an error calls the stream, None for errors that are dropped."""
        self._descriptor = descriptor
        self._name = name
        self._failed = False

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._descriptor

    def isatty(self) -> bool:
        return os.isatty(self._descriptor)

    def write(self, data: bytes | memoryview) -> int:  # type: ignore[override]
        if self._failed:
            return len(data)
        try:
            return os.write(self._descriptor, data)
        except OSError as error:
            self._failed = True
            if self._name is None:
                return len(data)
            if error.errno == errno.EPIPE:
                raise StreamError(f"{self._name} was closed by its reader.") from error
            raise StreamError(f"{self._name} cannot be written: {reason_of(error)}.") from error


def guard_streams() -> None:
    """Put guarded streams in the place of ``sys.stdout`` and ``sys.stderr``."""
    for descriptor in (0, 1, 2):
        try:
            os.fstat(descriptor)
        except OSError:
            os.open(os.devnull, os.O_RDWR)  # takes the lowest number that is free: this one
    sys.stdin = sys.stdin or io.TextIOWrapper(io.FileIO(0))
    sys.stdout = _guarded(sys.stdout, 1, "Standard output")
    sys.stderr = _guarded(sys.stderr, 2, None)


def _guarded(stream: TextIO | None, descriptor: int, name: str | None) -> TextIO:
    encoding = getattr(stream, "encoding", None) or "utf-8"
    if sys.platform == "win32" and stream is not None and stream.isatty():
        stream.reconfigure(errors="replace")  # type: ignore[attr-defined]
        return stream  # a Windows console takes characters, not bytes
    raw = _Raw(descriptor, name)
    # A pipe in a code page must not break on a degree sign.
    return io.TextIOWrapper(
        io.BufferedWriter(raw),  # type: ignore[type-var]
        encoding=encoding,
        errors="replace",
        line_buffering=name is None or raw.isatty(),
        write_through=name is None,
    )
