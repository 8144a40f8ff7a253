"""Text of mesh files: any byte-order mark, lines of bounded length, strict numbers."""

from __future__ import annotations

import codecs
import io
from typing import TYPE_CHECKING

from printprep.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

# A face of 100,000 corners takes less; what is longer is not the text of a mesh.
LINE_CHARACTERS_MAX = 4 << 20
_MARKS = (
    (codecs.BOM_UTF8, "utf-8"),
    (codecs.BOM_UTF16_LE, "utf-16-le"),
    (codecs.BOM_UTF16_BE, "utf-16-be"),
)


def without_mark(data: bytes) -> bytes:
    """Text without its byte-order mark, and with one byte for each ASCII character.

    UTF-16 text (as Windows shells redirect it) becomes UTF-8.  Bytes that only begin like UTF-16,
    as a binary header may, stay as they are.
    """
    for mark, encoding in _MARKS:
        if data.startswith(mark):
            if encoding == "utf-8":
                return data[len(mark) :]
            try:
                return data[len(mark) :].decode(encoding).encode()
            except UnicodeDecodeError:
                return data
    return data


def numbered_lines(data: bytes, what: str) -> Iterator[tuple[int, str]]:
    """The lines of a text from 1 on, whatever ends them; ``what`` names the file in errors.

    Raises InputError for a line longer than any of a mesh, before the next one is read.
    """
    # Latin-1 decodes every byte; only names can hold more than ASCII, and they are not used.
    text = io.TextIOWrapper(io.BytesIO(data), encoding="latin-1", newline=None)
    number = 0
    while line := text.readline(LINE_CHARACTERS_MAX):
        number += 1
        if len(line) >= LINE_CHARACTERS_MAX:
            raise InputError(
                f"{what}, line {number}: the line has more than {LINE_CHARACTERS_MAX} characters, "
                "as no mesh has.",
                "Export the model again, as triangles.",
            )
        yield number, line


def three_numbers(words: list[str]) -> tuple[float, float, float]:
    """Exactly three numbers.  Raises ValueError for other words, and for Python's ``2_0``."""
    x, y, z = words
    if "_" in x or "_" in y or "_" in z:
        raise ValueError("a number has an underscore")
    return float(x), float(y), float(z)


def whole_number(word: str) -> int:
    """A whole number of an array's size.  Raises ValueError for anything else."""
    if "_" in word or len(word) > 20:
        raise ValueError("no index")
    return int(word)
