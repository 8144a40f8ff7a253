"""Changes the user's G-code in place: the file is whole at every moment.

The new content is written beside the file, forced to the disk and takes the file's name in one
step (``files.replacing``).  A program that is stopped, however hard, leaves the old file or the
new one.  The figures are "; printprep: " lines: the last lines of a text, the last block of a
binary G-code, the last lines of the plate in a sliced project.
"""

from __future__ import annotations

import hashlib
import shutil
import tempfile
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import IO, BinaryIO

from printprep.bgcode.blocks import GCODE, STORED, gcode_block, is_binary, read_blocks, read_header
from printprep.errors import InputError, OutputError, ToolError
from printprep.files import reason_of, replacing
from printprep.gcode.source import is_binary_file
from printprep.threemf.plate import ZIP_ERRORS, ZIP_MAGIC, plate_in

MARK = b"; printprep: "
_TAIL_BYTES = 1 << 16
_COPY_BYTES = 1 << 20


def annotate(gcode: Path, lines: Iterable[str]) -> None:
    """Put "; printprep: " lines at the end of a G-code, in place of those that already end it.

    Raises OutputError where the file cannot be rewritten; it is unchanged then.
    """
    try:
        with gcode.open("rb") as old:
            head = old.read(len(ZIP_MAGIC))
            old.seek(0)
            if is_binary(head):
                _annotate_binary(gcode, old, _notes(lines))
            elif head == ZIP_MAGIC:
                _annotate_project(gcode, old, _notes(lines))
            else:
                kept, newline = _without_notes(old)
                _replace(gcode, old, kept, newline + _notes(lines))
    except OSError as error:
        raise _refused(gcode, error) from error


def replace_content(gcode: Path, source: Path, lines: Iterable[str]) -> None:
    """Replace the content of a G-code by that of ``source``, with "; printprep: " lines at its end.

    Raises OutputError where the file cannot be rewritten, ToolError where ``source`` is text and
    the G-code binary, or the other way round; it is unchanged then.
    """
    try:
        binary = is_binary_file(gcode)
        if binary != is_binary_file(source):
            raise ToolError(
                f"{gcode.name} is unchanged: it is {'binary G-code' if binary else 'text'}, and "
                f"the slicer wrote {'text' if binary else 'binary G-code'}.",
                "Name the slicer that exported it with --slicer, or set Binary G-code "
                "(binary_gcode) in both alike.",
            )
        with source.open("rb") as new:
            if binary:
                _annotate_binary(gcode, new, _notes(lines))
            else:
                _replace(gcode, new, source.stat().st_size, _notes(lines))
    except OSError as error:
        raise _refused(gcode, error) from error


def _annotate_binary(target: Path, source: BinaryIO, notes: bytes) -> None:
    """Replace a file by the blocks of ``source`` with ``notes`` as the last block."""
    checksummed = read_header(source, target.name)
    kept = source.tell()
    source.seek(0)
    for block in read_blocks(source, target.name):
        plain = block.kind == GCODE and block.compression == STORED and block.encoding == 0
        if not (plain and all(line.startswith(MARK) for line in block.data.splitlines())):
            kept = block.end
    source.seek(0)
    _replace(target, source, kept, gcode_block(notes, checksummed=checksummed))


def _annotate_project(target: Path, old: BinaryIO, notes: bytes) -> None:
    """Replace a sliced project by one with ``notes`` at the end of its plate, and its MD5."""
    try:
        with zipfile.ZipFile(old) as source, replacing(target) as out:
            plate = plate_in(source, target.name)
            with tempfile.TemporaryFile() as text:
                with source.open(plate) as packed:
                    shutil.copyfileobj(packed, text, _COPY_BYTES)
                kept, newline = _without_notes(text)
                text.truncate(kept)
                text.seek(kept)
                text.write(newline + notes)
                text.seek(0)
                digest = hashlib.file_digest(text, "md5").hexdigest().upper()
                with zipfile.ZipFile(out, "w") as sink:
                    for entry in source.infolist():
                        with sink.open(_same(entry), "w") as copy:
                            if entry.filename == plate.filename:
                                text.seek(0)
                                shutil.copyfileobj(text, copy, _COPY_BYTES)
                            elif entry.filename == f"{plate.filename}.md5":
                                copy.write(digest.encode("ascii"))
                            else:
                                with source.open(entry) as packed:
                                    shutil.copyfileobj(packed, copy, _COPY_BYTES)
    except OSError:
        raise
    except ZIP_ERRORS as error:
        raise InputError(f"{target.name} is not a sound archive: {error}.") from error


def _same(entry: zipfile.ZipInfo) -> zipfile.ZipInfo:
    """A new entry with the name, time, kind and compression of another."""
    copy = zipfile.ZipInfo(entry.filename, entry.date_time)
    copy.compress_type = entry.compress_type
    copy.external_attr = entry.external_attr
    copy.file_size = entry.file_size  # decides whether the entry needs 64-bit sizes
    return copy


def _replace(target: Path, content: BinaryIO, size: int, notes: bytes) -> None:
    """Put the first ``size`` bytes of ``content``, then ``notes``, in the place of a file."""
    content.seek(0)
    with replacing(target) as out:
        shutil.copyfileobj(content, out, _COPY_BYTES)
        out.truncate(size)
        out.seek(size)
        out.write(notes)


def _notes(lines: Iterable[str]) -> bytes:
    return b"".join(MARK + line.encode("ascii", "replace") + b"\n" for line in lines)


def _without_notes(file: IO[bytes]) -> tuple[int, bytes]:
    """Bytes of a text before the notes at its end, and the end of a line where it lacks one."""
    size = file.seek(0, 2)
    start = max(0, size - _TAIL_BYTES)
    file.seek(start)
    lines = file.read().splitlines(keepends=True)
    while lines and lines[-1].startswith(MARK):
        size -= len(lines.pop())
    return size, b"" if not lines or lines[-1].endswith(b"\n") else b"\n"


def _refused(gcode: Path, error: OSError) -> OutputError:
    return OutputError(f"{gcode.name} is unchanged: it cannot be rewritten ({reason_of(error)}).")
