"""The text of a G-code file in whole lines: of text, of binary G-code, or of a sliced project."""

from __future__ import annotations

import stat
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from printprep.bgcode.blocks import is_binary
from printprep.bgcode.content import text_of
from printprep.errors import InputError
from printprep.files import reason_of
from printprep.threemf.plate import ZIP_MAGIC, plate_text

_PIECE_BYTES = 4 << 20
_LINE_BYTES_MAX = 16 << 20


def pieces(path: Path) -> Iterator[bytes]:
    """The text of a file in pieces of about 4 MiB that end with the end of a line.

    Raises InputError where it cannot be read, is no plain file, is damaged, or has a line of more
    than 16 MiB.
    """
    try:
        with open_plain(path) as file:
            yield from _whole_lines(_chunks(file, path.name), path.name)
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Check the name and the folder.") from error
    except OSError as error:
        raise InputError(f"{path.name} cannot be read: {reason_of(error)}.") from error


def open_plain(path: Path) -> BinaryIO:
    """A file opened for reading.  Raises OSError, and InputError for what has no end (a device)."""
    if not stat.S_ISREG(path.stat().st_mode):
        raise InputError(f"{path} is not a plain file.", "Name a G-code file.")
    return path.open("rb")


def is_binary_file(path: Path) -> bool:
    """Whether a file is binary G-code.  Raises OSError, and InputError for a device."""
    with open_plain(path) as file:
        return is_binary(file.read(len(ZIP_MAGIC)))


def _chunks(file: BinaryIO, name: str) -> Iterator[bytes]:
    """The text in pieces that may end within a line."""
    head = file.read(len(ZIP_MAGIC))
    file.seek(0)
    if is_binary(head):
        yield from text_of(file, name)
    elif head == ZIP_MAGIC:
        yield from plate_text(file, name)
    else:
        while piece := file.read(_PIECE_BYTES):
            yield piece


def _whole_lines(chunks: Iterator[bytes], name: str) -> Iterator[bytes]:
    """Pieces that end with the end of a line; the last one is given one where it lacks it."""
    held: list[bytes] = []
    size = 0
    for chunk in chunks:
        end = chunk.rfind(b"\n") + 1
        if end and size + end >= _PIECE_BYTES // 2:
            yield b"".join([*held, chunk[:end]])
            held, size = [chunk[end:]], len(chunk) - end
            continue
        held.append(chunk)
        size += len(chunk)
        if size > _LINE_BYTES_MAX + _PIECE_BYTES:
            raise InputError(
                f"{name} is not G-code: it has a line of more than {_LINE_BYTES_MAX >> 20} MiB."
            )
    if size:
        whole = b"".join(held)
        yield whole if whole.endswith(b"\n") else whole + b"\n"
