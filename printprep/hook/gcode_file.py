"""Changes the user's G-code in place: the file is whole at every moment.

The new content is written beside the file, forced to the disk and takes the file's name in one
step (``files.replacing``).  A program that is stopped, however hard, leaves the old file or the
new one.
"""

from __future__ import annotations

import shutil
from collections.abc import Iterable
from pathlib import Path
from typing import BinaryIO

from printprep.errors import OutputError
from printprep.files import reason_of, replacing

MARK = b"; printprep: "
_TAIL_BYTES = 1 << 16
_COPY_BYTES = 1 << 20


def annotate(gcode: Path, lines: Iterable[str]) -> None:
    """Put "; printprep: " lines at the end of a G-code, in place of those that already end it.

    Raises OutputError where the file cannot be rewritten; it is unchanged then.
    """
    try:
        kept = _without_notes(gcode)
        newline = b"" if _ends_line(gcode, kept) else b"\n"
        with gcode.open("rb") as old:
            _replace(gcode, old, kept, newline + _notes(lines))
    except OSError as error:
        raise _refused(gcode, error) from error


def replace_content(gcode: Path, source: Path, lines: Iterable[str]) -> None:
    """Replace the content of a G-code by that of ``source``, with "; printprep: " lines at its end.

    Raises OutputError where the file cannot be rewritten; it is unchanged then.
    """
    try:
        with source.open("rb") as new:
            _replace(gcode, new, source.stat().st_size, _notes(lines))
    except OSError as error:
        raise _refused(gcode, error) from error


def _replace(target: Path, content: BinaryIO, size: int, notes: bytes) -> None:
    """Put the first ``size`` bytes of ``content``, then ``notes``, in the place of a file."""
    with replacing(target) as out:
        shutil.copyfileobj(content, out, _COPY_BYTES)
        out.truncate(size)
        out.seek(size)
        out.write(notes)


def _notes(lines: Iterable[str]) -> bytes:
    return b"".join(MARK + line.encode("ascii", "replace") + b"\n" for line in lines)


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
    return OutputError(f"{gcode.name} is unchanged: it cannot be rewritten ({reason_of(error)}).")
