"""Reads PLY, text and binary: positions and faces only.

printprep has its own reader because an error says how many faces are missing, because a file's
counts are compared with its size before any memory is taken, and because nothing that a file names
(textures) is opened.  Format: Greg Turk, "The PLY polygon file format", 1994.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import InputError
from printprep.mesh.limits import TRIANGLES_MAX, refuse_too_many
from printprep.mesh.text import LINE_CHARACTERS_MAX, numbered_lines, without_mark
from printprep.types import ReadNote
from printprep.wording import counted, shortened

if TYPE_CHECKING:
    from collections.abc import Iterator

    from printprep.arrays import Float, Int

_AGAIN = "Export the model again, as binary STL if possible."
_HEADER_MAX = 64 << 10
# Names of the numbers, old and new, as struct writes them.
_TYPES = {
    **dict.fromkeys(("char", "int8"), "b"),
    **dict.fromkeys(("uchar", "uint8"), "B"),
    **dict.fromkeys(("short", "int16"), "h"),
    **dict.fromkeys(("ushort", "uint16"), "H"),
    **dict.fromkeys(("int", "int32"), "i"),
    **dict.fromkeys(("uint", "uint32"), "I"),
    **dict.fromkeys(("float", "float32"), "f"),
    **dict.fromkeys(("double", "float64"), "d"),
}
_WHOLE = frozenset("bBhHiI")
_CORNERS = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class _Property:
    """One property of an element; ``length`` is the type of a list's length, None for a number."""

    name: str
    kind: str
    length: str | None


@dataclass(frozen=True)
class _Element:
    name: str
    count: int
    properties: tuple[_Property, ...]

    @property
    def lists(self) -> tuple[_Property, ...]:
        return tuple(item for item in self.properties if item.length is not None)


@dataclass(frozen=True)
class _Header:
    """order : "<", ">" or "" for text;  end : where the rows begin."""

    order: str
    elements: tuple[_Element, ...]
    end: int


@dataclass(frozen=True, eq=False)
class PlyMesh:
    """What a PLY file holds.

    vertices : (n, 3) float64 in the file's unit;  faces : (m, 3) int64;  notes : as in ReadNote.
    """

    vertices: Float
    faces: Int
    notes: tuple[ReadNote, ...] = ()


class _EndError(Exception):
    """The file ends before a row is whole."""


def read_ply(data: bytes, what: str, *, partial: bool = False) -> PlyMesh:
    """The triangles of a PLY file; ``what`` names the file in errors.

    A polygon becomes a fan of triangles from its first corner.
    partial : take the faces that are there from a file that is cut short.

    Raises
    ------
    InputError : the file is cut short or not PLY, a face has fewer than three corners or one that
        does not exist, or a number cannot be read.
    """
    try:
        return _read(without_mark(data), what, partial)
    except (ValueError, OverflowError, struct.error) as error:
        raise InputError(f"{what} cannot be read as PLY: {error}.", _AGAIN) from error


def _read(data: bytes, what: str, partial: bool) -> PlyMesh:
    header = _header(data)
    rows = _Text(data, header.end, what) if not header.order else _Binary(data, header)
    vertices = np.zeros((0, 3))
    faces: Any = np.zeros((0, 3), dtype=np.int64)
    notes: list[ReadNote] = []
    seen: set[str] = set()
    for element in header.elements:
        if element.name in seen:
            raise ValueError(f"its header names the element {shortened(element.name)} twice")
        seen.add(element.name)
        if element.name == "vertex":
            vertices = _vertices(rows, element, what)
        elif element.name == "face":
            faces, there = _faces(rows, element, what)
            if there < element.count:
                notes.append(_cut_short(what, partial, there, element.count))
                break
        elif element.name == "tristrips":
            raise ValueError("its triangles are in strips, which printprep does not read")
        elif {"vertex", "face"} <= seen:
            break
        else:
            rows.skip(element)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        worst = int(faces.min()) if faces.min() < 0 else int(faces.max())
        raise ValueError(f"a face uses vertex {worst}, the file has {len(vertices)} from 0 on")
    return PlyMesh(vertices, faces, (*notes, *_colour_notes(header)))


def _header(data: bytes) -> _Header:
    head = data[:_HEADER_MAX].replace(b"\r\n", b"\n").replace(b"\r", b"\n")
    if not head.startswith(b"ply\n"):
        raise ValueError("it does not begin with 'ply'")
    end = data.find(b"end_header", 0, _HEADER_MAX)
    if end < 0:
        raise ValueError(f"its header has no end in its first {_HEADER_MAX} bytes")
    text = data[:end].decode("latin-1").replace("\r\n", "\n").replace("\r", "\n")
    after = end + len(b"end_header")
    after += 2 if data[after : after + 2] == b"\r\n" else 1
    order: str | None = None
    elements: list[_Element] = []
    for line in text.split("\n")[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info"):
            continue
        if words[0] == "format" and len(words) >= 2:
            orders = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
            if words[1] not in orders:
                raise ValueError(f"its format {shortened(words[1])} is not known")
            order = orders[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdecimal():
            if len(words[2]) > 12:
                raise ValueError(f"its header promises {shortened(words[2], 20)} {words[1]} rows")
            elements.append(_Element(words[1], int(words[2]), ()))
        elif words[0] == "property" and elements:
            last = elements[-1]
            added = _property(words)
            elements[-1] = _Element(last.name, last.count, (*last.properties, added))
        else:
            raise ValueError(f"its header has the line {shortened(line)!r}")
    if order is None:
        raise ValueError("its header names no format")
    return _Header(order, tuple(elements), after)


def _property(words: list[str]) -> _Property:
    types = words[2:4] if words[1:2] == ["list"] else words[1:2]
    unknown = [word for word in types if word not in _TYPES]
    if unknown or len(words) != (5 if len(types) == 2 else 3):
        raise ValueError(f"its header has the property {shortened(' '.join(words[1:]))!r}")
    kinds = [_TYPES[word] for word in types]
    if len(kinds) == 1:
        return _Property(words[2], kinds[0], None)
    if kinds[0] not in _WHOLE:
        raise ValueError(f"the lengths of its list {shortened(words[4])} are {words[2]}, no counts")
    return _Property(words[4], kinds[1], kinds[0])


def _vertices(rows: _Text | _Binary, element: _Element, what: str) -> Float:
    """(n, 3) float64.  Without all of them no face can be told: then the file is refused."""
    names = [item.name for item in element.properties]
    if any(names.count(axis) != 1 for axis in "xyz") or any(p.name in "xyz" for p in element.lists):
        raise ValueError("its vertices have no x, y and z")
    try:
        return rows.columns(element, ("x", "y", "z"))
    except _EndError:
        raise InputError(
            f"{what} is cut short: its header promises {element.count} vertices, and they are not "
            "all there.",
            "Export or download the file again.",
        ) from None


def _faces(rows: _Text | _Binary, element: _Element, what: str) -> tuple[Int, int]:
    """Triangles (m, 3) of the faces that are whole, and the number of those faces."""
    named = [item for item in element.lists if item.name in _CORNERS]
    if len(named) != 1 or named[0].kind not in _WHOLE:
        raise ValueError("its faces have no list of whole numbers, vertex_indices")
    fans: list[Int] = []
    there = triangles = 0
    for polygons in rows.polygons(element, named[0]):
        if polygons.shape[1] < 3:
            raise ValueError(f"a face has {polygons.shape[1]} corners, it needs three or more")
        triangles += len(polygons) * (polygons.shape[1] - 2)
        if triangles > TRIANGLES_MAX:
            refuse_too_many(triangles, what)
        first, rest = polygons[:, :1, None], polygons[:, 1:]
        pairs = np.stack([rest[:, :-1], rest[:, 1:]], axis=2)
        fan = np.concatenate([np.broadcast_to(first, (*pairs.shape[:2], 1)), pairs], axis=2)
        fans.append(fan.reshape(-1, 3))
        there += len(polygons)
    return (np.concatenate(fans) if fans else np.zeros((0, 3), dtype=np.int64)), there


def _cut_short(what: str, partial: bool, there: int, promised: int) -> ReadNote:
    if not partial or not there:
        raise InputError(
            f"{what} is cut short: it holds {counted(there, 'whole face')}, its header promises "
            f"{promised}.",
            "Export or download the file again, or take the faces that are there with --partial."
            if there
            else "Export or download the file again.",
        )
    return ReadNote(
        "cut-short",
        f"The file is cut short: only the {counted(there, 'whole face')} of {promised} that it "
        "holds were read.",
        "Export or download the file again.",
    )


def _colour_notes(header: _Header) -> tuple[ReadNote, ...]:
    names = {item.name for element in header.elements for item in element.properties}
    if not {"red", "green", "blue"} <= names:
        return ()
    return (
        ReadNote(
            "colours-lost",
            "The colours of the PLY file are not read: the part has none.",
            "Save the model as a 3MF with its colours to keep them on the outside.",
        ),
    )


class _Text:
    """Rows of a text file, one on each line."""

    def __init__(self, data: bytes, start: int, what: str) -> None:
        self._lines = numbered_lines(data[start:], what)

    def _row(self) -> list[str]:
        for _, line in self._lines:
            words = line.split()
            if words:
                if "_" in line:
                    raise ValueError(f"a row holds no numbers: {shortened(line)}")
                return words
        raise _EndError

    def skip(self, element: _Element) -> None:
        try:
            for _ in range(element.count):
                self._row()
        except _EndError:
            return

    def columns(self, element: _Element, names: tuple[str, ...]) -> Float:
        index = [[p.name for p in element.properties].index(name) for name in names]
        simple = not element.lists
        found: list[tuple[float, ...]] = []
        for _ in range(element.count):
            words = self._row()
            row = words if simple else [word for (word, *_) in _split(words, element)]
            if max(index) >= len(row):
                raise _EndError
            found.append(tuple(float(row[place]) for place in index))
        return np.array(found, dtype=np.float64).reshape(-1, len(names))

    def polygons(self, element: _Element, corners: _Property) -> Iterator[Int]:
        """Faces as (k, corners), those with equally many corners together."""
        place = element.properties.index(corners)
        kept: list[list[int]] = []
        for _ in range(element.count):
            try:
                face = [int(word) for word in _split(self._row(), element)[place]]
            except _EndError:
                break
            if kept and len(kept[0]) != len(face):
                yield np.array(kept, dtype=np.int64)
                kept = []
            kept.append(face)
        if kept:
            yield np.array(kept, dtype=np.int64).reshape(len(kept), -1)


def _split(words: list[str], element: _Element) -> list[list[str]]:
    """The words of a row, those of each property.  Raises _EndError where there are too few."""
    found: list[list[str]] = []
    at = 0
    for item in element.properties:
        if item.length is None:
            length = 1
        elif at < len(words):
            length, at = int(words[at]), at + 1
        else:
            raise _EndError
        if length < 0 or at + length > len(words):
            raise _EndError
        found.append(words[at : at + length])
        at += length
    return found


class _Binary:
    """Rows of a binary file, one after another."""

    def __init__(self, data: bytes, header: _Header) -> None:
        self._data, self._order, self._at = data, header.order, header.end

    def _plain(self, element: _Element, lengths: tuple[int, ...]) -> np.dtype[Any]:
        """One row as numpy reads it, if every list has the length given for it."""
        fields: list[Any] = []
        left = iter(lengths)
        for number, item in enumerate(element.properties):
            kind = self._order + item.kind
            if item.length is not None:
                fields.append((f"length{number}", self._order + item.length))
                fields.append((f"value{number}", kind, (next(left),)))
            else:
                fields.append((f"value{number}", kind))
        return np.dtype(fields)

    def skip(self, element: _Element) -> None:
        if not element.lists:
            self._at += element.count * self._plain(element, ()).itemsize
        else:
            for _ in self._walk(element, element.lists[0]):
                pass

    def columns(self, element: _Element, names: tuple[str, ...]) -> Float:
        index = [[p.name for p in element.properties].index(name) for name in names]
        rows = self._alike(element)
        if rows is None or len(rows) < element.count:
            if not element.lists:
                raise _EndError
            raise ValueError("its vertices hold lists")
        self._at += rows.nbytes
        with np.errstate(invalid="ignore"):  # a signalling NaN; what is not finite is refused later
            return np.stack([rows[f"value{place}"] for place in index], axis=1).astype(np.float64)

    def polygons(self, element: _Element, corners: _Property) -> Iterator[Int]:
        """Faces as (k, corners), those with equally many corners together."""
        rows = self._alike(element)
        if rows is not None:
            self._at += rows.nbytes
            if len(rows):
                yield rows[f"value{element.properties.index(corners)}"].astype(np.int64)
            return
        places = np.array(list(self._walk(element, corners)), dtype=np.int64).reshape(-1, 2)
        content = np.frombuffer(self._data, np.uint8)
        kind = np.dtype(self._order + corners.kind)
        for length in np.unique(places[:, 1]).tolist():
            starts = places[places[:, 1] == length, 0]
            taken = content[starts[:, None] + np.arange(length * kind.itemsize)]
            yield taken.view(kind).astype(np.int64).reshape(len(starts), length)

    def _alike(self, element: _Element) -> Any:
        """The rows that are whole, if the lists of all have the lengths of the first, else None."""
        lengths = self._lengths(element)
        if not element.count or lengths is None:
            return np.zeros(0, self._plain(element, (0,) * len(element.lists)))
        plain = self._plain(element, lengths)
        room = (len(self._data) - self._at) // plain.itemsize
        rows = np.frombuffer(self._data, plain, min(element.count, room), self._at)
        places = [n for n, item in enumerate(element.properties) if item.length is not None]
        for number, length in zip(places, lengths, strict=True):
            if not (rows[f"length{number}"] == length).all():
                return None
        return rows

    def _walk(self, element: _Element, wanted: _Property) -> Iterator[tuple[int, int]]:
        """Row by row, where the values of one list begin, and how many they are."""
        sizes = [
            (
                item is wanted,
                item.length and struct.Struct(self._order + item.length),
                struct.calcsize(self._order + item.kind),
            )
            for item in element.properties
        ]
        data, end, at = self._data, len(self._data), self._at
        for _ in range(element.count):
            found = (0, 0)
            for is_wanted, length_of, size in sizes:
                if not length_of:
                    at += size
                    continue
                if at + length_of.size > end:
                    return
                (length,) = length_of.unpack_from(data, at)
                at += length_of.size
                if not 0 <= length <= LINE_CHARACTERS_MAX:
                    raise ValueError(f"a row has a list of {length} numbers")
                if is_wanted:
                    found = (at, length)
                at += length * size
            if at > end:
                return
            self._at = at
            yield found

    def _lengths(self, element: _Element) -> tuple[int, ...] | None:
        """The lengths of the lists in the next row, None where it is not whole."""
        lengths = []
        at = self._at
        for item in element.properties:
            size = struct.calcsize(self._order + item.kind)
            if item.length is None:
                at += size
                continue
            first = at + struct.calcsize(self._order + item.length)
            if first > len(self._data):
                return None
            (length,) = struct.unpack_from(self._order + item.length, self._data, at)
            if not 0 <= length <= LINE_CHARACTERS_MAX:
                raise ValueError(f"a row has a list of {length} numbers")
            lengths.append(length)
            at = first + length * size
        return tuple(lengths) if at <= len(self._data) else None
