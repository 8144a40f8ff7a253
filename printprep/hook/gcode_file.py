"""The user's G-code, changed in place: whole before, whole after, at every moment in between.

The new content is written beside the file, forced to the disk and takes the file's name in one
step.  Whoever stops the program, however hard, leaves the old file or the new one.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from printprep.errors import OutputError

MARK = b"; printprep: "
_TAIL_BYTES = 1 << 16


def annotate(gcode: Path, lines: Iterable[str]) -> None:
    """Put "; printprep: " lines at the end of a G-code, instead of those it ends with already.

    Raises OutputError where the file cannot be rewritten; it is then as it was.
    """
    notes = b"".join(MARK + line.encode("ascii", "replace") + b"\n" for line in lines)
    try:
        kept = _without_notes(gcode)
        newline = b"" if _ends_line(gcode, kept) else b"\n"
        with gcode.open("rb") as old:
            _replace(gcode, old, kept, newline + notes)
    except OSError as error:
        raise _refused(gcode, error) from error


def replace_content(gcode: Path, source: Path, lines: Iterable[str]) -> None:
    """Let a G-code hold what ``source`` holds, with "; printprep: " lines at its end.

    Raises OutputError where the file cannot be rewritten; it is then as it was.
    """
    notes = b"".join(MARK + line.encode("ascii", "replace") + b"\n" for line in lines)
    try:
        with source.open("rb") as new:
            _replace(gcode, new, source.stat().st_size, notes)
    except OSError as error:
        raise _refused(gcode, error) from error


def _replace(target: Path, content: BinaryIO, size: int, notes: bytes) -> None:
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.", suffix=".part")
    beside = Path(name)
    try:
        with os.fdopen(handle, "wb") as out:
            shutil.copyfileobj(content, out, 1 << 20)
            out.truncate(size)
            out.seek(size)
            out.write(notes)
            out.flush()
            os.fsync(out.fileno())
        beside.chmod(target.stat().st_mode & 0o777)
        beside.replace(target)
    finally:
        # After a success the name is gone already; after a failure it must be
        with contextlib.suppress(OSError):
            beside.unlink(missing_ok=True)


def _without_notes(gcode: Path) -> int:
    """Bytes of the file before the notes at its end."""
    size = gcode.stat().st_size
    with gcode.open("rb") as file:
        start = max(0, size - _TAIL_BYTES)
        file.seek(start)
        lines = file.read().splitlines(keepends=True)
    while lines and lines[-1].startswith(MARK):
        size -= len(lines.pop())
    return size


def _ends_line(gcode: Path, size: int) -> bool:
    if size == 0:
        return True
    with gcode.open("rb") as file:
        file.seek(size - 1)
        return file.read(1) == b"\n"


def _refused(gcode: Path, error: OSError) -> OutputError:
    reason = error.strerror or type(error).__name__
    return OutputError(f"{gcode.name}: cannot be rewritten ({reason}); it is as it was")
