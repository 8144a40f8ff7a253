"""Reads STL, binary and ASCII, in all the variants that exporters write.

printprep has its own reader because an error says what is wrong with the file (how many triangles
the header promises and how many there are, which line cannot be read), and because it accepts ASCII
files with carriage returns only, or with words after ``endloop``.

Binary (3D Systems, 1988): 80 bytes of anything, a little-endian uint32 count n, then n records of
50 bytes: normal, three corners as float32, two bytes of attributes.  The stored normal is not
used: the order of the corners defines the outside.
"""

from __future__ import annotations

import struct
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError

if TYPE_CHECKING:
    from printprep.arrays import Float


_AGAIN = "Export the model again, as binary STL if possible."
_HEADER = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
# First words of lines that carry no geometry.
_OTHER = frozenset({"solid", "endsolid", "facet", "endfacet", "outer", "color", "#"})


def read_stl(data: bytes, what: str) -> Float:
    """Corners (m, 3 corners, 3 xyz) float64 in the file's unit; ``what`` names the file in errors.

    Raises
    ------
    InputError : the file is truncated or not STL, a facet does not have exactly three corners, or
        a number cannot be read.
    """
    # The count decides first, compared with the size: many binary files begin with "solid".
    count = struct.unpack_from("<I", data, 80)[0] if len(data) >= _HEADER else 0
    promised = _HEADER + count * _RECORD.itemsize
    # Text has no zero byte; a binary file has some, in its header or its attributes.
    if len(data) == promised or b"\x00" in data[:4096]:
        if len(data) < promised:
            raise InputError(
                f"{what} is cut short: its header promises {count} triangles "
                f"({promised} bytes), the file has {len(data)} bytes.",
                "Export or download the file again.",
            )
        records = np.frombuffer(data, dtype=_RECORD, count=count, offset=_HEADER)
        return records["corners"].astype(np.float64)
    if data.lstrip()[:5].lower() != b"solid":
        raise InputError(
            f"{what} is not an STL file: it is text that does not begin with 'solid', or its "
            f"{len(data)} bytes do not match the triangle count in its header.",
            "Export the model as binary STL, OBJ, PLY, GLB or 3MF.",
        )
    return _read_ascii(data, what)


def _read_ascii(data: bytes, what: str) -> Float:
    """Corners (m, 3 corners, 3 xyz) of an ASCII file."""
    # Latin-1 decodes every byte; only names can hold more than ASCII, and they are not used.
    corners: list[list[float]] = []
    facet: list[list[float]] = []
    in_name = False
    for number, line in enumerate(data.decode("latin-1").splitlines(), start=1):
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
            corners += facet
            facet = []
        elif key not in _OTHER and not in_name:
            raise InputError(
                f"{what}, line {number}: {words[0][:20]!r} is not a word of an STL file.",
                _AGAIN,
            )
        # splitlines also cuts at characters that a name may hold (form feed, next line …).
        in_name = key == "solid" or (in_name and key not in _OTHER and key != "vertex")
    if facet:
        raise InputError(
            f"{what} is cut short: the last facet has no 'endloop'.",
            "Export or download the file again.",
        )
    return np.array(corners, dtype=np.float64).reshape(-1, 3, 3)


def _vertex(words: list[str], what: str, number: int) -> list[float]:
    try:
        values = [float(word) for word in words]
    except ValueError as error:
        raise InputError(
            f"{what}, line {number}: a corner is not three numbers.",
            _AGAIN,
        ) from error
    if len(values) != 3:
        raise InputError(
            f"{what}, line {number}: a corner has {len(values)} coordinates, it needs three.",
            _AGAIN,
        )
    return values
