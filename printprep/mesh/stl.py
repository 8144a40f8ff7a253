"""Reads STL, binary and text, in all the variants that exporters write.

printprep has its own reader because an error says what is wrong with the file (how many facets
there are and how many its header names, which line cannot be read), and because it accepts text
with carriage returns only, with a byte-order mark, or with words after ``endloop``.

Binary (3D Systems, 1988): 80 bytes of anything, a little-endian uint32 count, then records of 50
bytes: normal, three corners as float32, two bytes of attributes.  The stored normal is not used:
the order of the corners defines the outside.

The count is often wrong: programs that stream write 0 or the largest number, others count by
themselves.  So the number of facets comes from the file's size.  A file is cut short where bytes
are missing and the facets that are there do not close.
"""

from __future__ import annotations

import struct
from array import array
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.mesh.limits import refuse_too_many
from printprep.mesh.text import numbered_lines, three_numbers, without_mark
from printprep.mesh.weld import is_closed, weld
from printprep.types import ReadNote
from printprep.wording import counted, shortened

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


_AGAIN = "Export the model again, as binary STL if possible."
_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# What programs write that cannot go back to the header when they know the count.
_STREAMED = frozenset({0, 2**31 - 1, 2**32 - 1})
# First words of lines that carry no geometry.
_OTHER = frozenset({"solid", "endsolid", "facet", "endfacet", "outer", "color", "#"})
_HEAD_BYTES = 4096
# Facets beyond the header's count belong to the model unless they are this many times as far out.
_FOREIGN = 1e3


@dataclass(frozen=True, eq=False)
class Facets:
    """What an STL file holds.

    corners : (m, 3 corners, 3 xyz) float64 in the file's unit;  notes : what the user must know.
    """

    corners: Float
    notes: tuple[ReadNote, ...] = ()


def read_stl(data: bytes, what: str, *, partial: bool = False) -> Facets:
    """The facets of an STL file; ``what`` names the file in errors.

    partial : take the facets that are there from a file that is cut short.

    Raises
    ------
    InputError : the file is cut short or not STL, a facet does not have exactly three corners, or
        a number cannot be read.
    """
    # The count decides first, compared with the size: many binary files begin with "solid".
    exact = len(data) >= _HEADER and len(data) == _HEADER + _count(data) * _RECORD.itemsize
    text = data if exact else without_mark(data)
    begins = text.lstrip()[:5].lower() == b"solid"
    # Text has no zero byte; a binary file has some, in its header or its attributes.
    binary = b"\x00" in text[:_HEAD_BYTES] and not (begins and b"vertex" in text[:_HEAD_BYTES])
    if exact or binary:
        return _read_binary(data, what, partial)
    if not begins:
        raise InputError(
            f"{what} is not an STL file: it is text that does not begin with 'solid', or its "
            f"{len(data)} bytes do not match the triangle count in its header.",
            "Export the model as binary STL, OBJ, PLY, GLB or 3MF.",
        )
    return _read_text(text, what, partial)


def _count(data: bytes) -> int:
    return int(struct.unpack_from("<I", data, 80)[0])


def _read_binary(data: bytes, what: str, partial: bool) -> Facets:
    """The facets of a binary file: as many as it has room for, unless its header counts fewer."""
    if len(data) < _HEADER:
        raise InputError(
            f"{what} is cut short: a binary STL has a header of {_HEADER} bytes, the file has "
            f"{len(data)}.",
            "Export or download the file again.",
        )
    named = _count(data)
    there, left_over = divmod(len(data) - _HEADER, _RECORD.itemsize)
    refuse_too_many(there, what)
    records = np.frombuffer(data, dtype=_RECORD, count=there, offset=_HEADER)
    with np.errstate(invalid="ignore"):  # a signalling NaN; what is not finite is refused later
        corners = records["corners"].astype(np.float64)
    colours = _colour_notes(data, records["attribute"])
    if named == there:  # a few bytes may follow, as some programs leave
        return Facets(corners, colours)
    if named < there and named not in _STREAMED:
        if left_over or not _of_one_model(corners, named):
            beyond = len(data) - _HEADER - named * _RECORD.itemsize
            message = f"{counted(beyond, 'byte')} after the last facet of the file were left out."
            return Facets(corners[:named], (ReadNote("facet-count", message), *colours))
    elif (left_over or named not in _STREAMED) and not _closes(corners):
        return _cut_short(corners, what, partial, f"its header names {named}")
    message = (
        f"The header of the file names {counted(named, 'facet')}, the file has {there}; all "
        f"{there} were read."
    )
    return Facets(corners, (ReadNote("facet-count", message), *colours))


def _colour_notes(data: bytes, attributes: Int) -> tuple[ReadNote, ...]:
    """That the facets have colours, which two programs put into the attributes, (m,) each.

    VisCAM sets the highest bit of a coloured facet; Magics clears it, and says so in the header.
    One colour for all facets is what some programs write for none.
    """
    coded = b"COLOR=" in data[:80] or bool(((attributes & 0x8000) != 0).any())
    if not coded or not len(attributes) or (attributes == attributes[0]).all():
        return ()
    return (
        ReadNote(
            "colours-lost",
            "The colours of the STL file are not read: the part has none.",
            "Save the model as a 3MF with its colours to keep them on the outside.",
        ),
    )


def _of_one_model(corners: Float, named: int) -> bool:
    """Whether the records beyond the first ``named`` of corners (m, 3, 3) are facets of a model."""
    inside, beyond = np.abs(corners[:named]), np.abs(corners[named:])
    with np.errstate(invalid="ignore"):
        limit = _FOREIGN * float(inside.max(initial=0.0))
    return bool(np.isfinite(beyond).all() and (beyond <= limit).all())


def _closes(corners: Float) -> bool:
    """Whether facets (m, 3, 3) make a closed surface."""
    if not len(corners) or not np.isfinite(corners).all():
        return False
    _, faces = weld(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
    return len(faces) > 0 and is_closed(faces, once=False)


def _cut_short(corners: Float, what: str, partial: bool, promise: str) -> Facets:
    """The facets (m, 3, 3) of a file that ends too early, if they are asked for."""
    there = counted(len(corners), "whole facet")
    if not partial or not len(corners):
        raise InputError(
            f"{what} is cut short: it holds {there}, {promise}.",
            "Export or download the file again, or take the facets that are there with --partial."
            if len(corners)
            else "Export or download the file again.",
        )
    note = ReadNote(
        "cut-short",
        f"The file is cut short: only the {there} that it holds were read.",
        "Export or download the file again.",
    )
    return Facets(corners, (note,))


def _read_text(data: bytes, what: str, partial: bool) -> Facets:
    """The facets of a text file."""
    flat = array("d")  # nine numbers a facet
    facet: list[tuple[float, float, float]] = []
    in_name = ended = False
    line = ""
    try:
        for number, line in numbered_lines(data, what):
            words = line.split()
            if not words:
                continue
            key = words[0].lower()
            if key == "vertex":
                facet.append(_vertex(words[1:], what, number))
            elif key == "endloop":
                if len(facet) != 3:
                    raise InputError(
                        f"{what}, line {number}: a facet has {len(facet)} corners, it needs three.",
                        _AGAIN,
                    )
                for corner in facet:
                    flat.extend(corner)
                facet = []
            elif key not in _OTHER and not in_name:
                raise InputError(
                    f"{what}, line {number}: {shortened(words[0], 20)!r} is not a word of an STL "
                    "file.",
                    _AGAIN,
                )
            # A name may go on in a second line.
            in_name = key == "solid" or (in_name and key not in _OTHER and key != "vertex")
            ended = key == "endsolid"
    except InputError:
        if not _is_last(data, line):
            raise
        ended = False  # the file ends inside a word, a number or a facet
    corners = np.frombuffer(flat, dtype=np.float64).reshape(-1, 3, 3)
    refuse_too_many(len(corners), what)
    if facet or not (ended or _closes(corners)):
        return _cut_short(corners, what, partial, "and its last line is not the end of a solid")
    return Facets(corners)


def _is_last(data: bytes, line: str) -> bool:
    """Whether a line is the last of a text and nothing ends it."""
    return not line.endswith("\n") and data.endswith(line.encode("latin-1"))


def _vertex(words: list[str], what: str, number: int) -> tuple[float, float, float]:
    try:
        return three_numbers(words)
    except ValueError as error:
        fact = (
            f"a corner has {len(words)} coordinates, it needs three"
            if len(words) != 3
            else f"a corner is not three numbers: {shortened(' '.join(words))}"
        )
        raise InputError(f"{what}, line {number}: {fact}.", _AGAIN) from error
