"""Reads Wavefront OBJ: positions and faces only.

printprep has its own reader because trimesh drops faces it cannot use, takes index 0 for the last
vertex and opens the material files that a model names; and because an error names the line.
Format: Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
"""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.mesh.limits import TRIANGLES_MAX, refuse_too_many
from printprep.mesh.text import numbered_lines, three_numbers, whole_number, without_mark
from printprep.types import ReadNote
from printprep.wording import shortened

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

# No file within the limits has so many vertices.
_INDEX_MAX = 1 << 32


@dataclass(frozen=True, eq=False)
class ObjMesh:
    """What an OBJ file holds.

    vertices : (n, 3) float64 in the file's unit;  faces : (m, 3) int64;  notes : as in ReadNote.
    """

    vertices: Float
    faces: Int
    notes: tuple[ReadNote, ...] = ()


def read_obj(data: bytes, what: str) -> ObjMesh:
    """The triangles of an OBJ file.

    what : the file's name in errors.  A polygon becomes a fan of triangles from its first corner.
    Vertex colours, texture coordinates, normals, groups, lines and curves are ignored.

    Raises
    ------
    InputError : a vertex that is not three numbers, a face with fewer than three corners, or a
        corner that does not exist; the message names the line.
    """
    coordinates = array("d")
    corners = array("q")
    faces_before = array("q")  # triangles before each line with a face, and that line's number:
    lines = array("q")  # a face may name a vertex that comes later
    materials: set[str] = set()
    coloured = False
    for number, line in _lines(without_mark(data), what):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if words[0] == "v":
            coordinates.extend(_vertex(words, what, number))
            coloured = coloured or len(words) >= 7
        elif words[0] == "f":
            named = _corners(words, len(coordinates) // 3, what, number)
            faces_before.append(len(corners) // 3)
            lines.append(number)
            for b, c in pairwise(named[1:]):
                corners.extend((named[0], b, c))
            if len(corners) > 3 * TRIANGLES_MAX:
                refuse_too_many(len(corners) // 3, f"{what} up to line {number}")
        elif words[0] == "usemtl" and len(materials) < 2:
            materials.add(words[-1])
    vertices = np.frombuffer(coordinates, dtype=np.float64).reshape(-1, 3)
    faces = np.frombuffer(corners, dtype=np.int64).reshape(-1, 3)
    beyond = np.flatnonzero((faces >= len(vertices)).any(axis=1))
    if len(beyond):
        first = int(beyond[0])
        line_of = int(np.searchsorted(np.frombuffer(faces_before, np.int64), first, "right")) - 1
        raise _malformed(
            what,
            lines[line_of],
            f"a face uses vertex {int(faces[first].max()) + 1}, the file has {len(vertices)}",
        )
    return ObjMesh(vertices, faces, _colour_notes(len(materials), coloured))


def _colour_notes(materials: int, coloured: bool) -> tuple[ReadNote, ...]:
    if materials < 2 and not coloured:
        return ()
    what = "materials" if materials > 1 else "colours"
    return (
        ReadNote(
            "colours-lost",
            f"The {what} of the OBJ file are not read: the part has none.",
            "Save the model as a 3MF with its colours to keep them on the outside.",
        ),
    )


def _lines(data: bytes, what: str) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; a line that ends in a backslash is joined with the next."""
    begun: list[str] = []
    for number, raw in numbered_lines(data, what):
        line = raw.removesuffix("\n")
        if line.endswith("\\"):
            begun.append(line[:-1])
            continue
        yield number, " ".join([*begun, line]) if begun else line
        begun = []


def _vertex(words: list[str], what: str, number: int) -> tuple[float, float, float]:
    try:
        return three_numbers(words[1:4])
    except ValueError as error:
        fact = f"a vertex is not three numbers: {shortened(' '.join(words[1:4]))}"
        raise _malformed(what, number, fact) from error


def _corners(words: list[str], so_far: int, what: str, number: int) -> list[int]:
    """Zero-based vertex indices of a face; negative numbers in the file count from the last."""
    try:
        named = [whole_number(word.partition("/")[0]) for word in words[1:]]
    except ValueError as error:
        raise _malformed(what, number, "a corner of a face is not a whole number") from error
    if len(named) < 3:
        raise _malformed(what, number, f"a face has {len(named)} corners, it needs three or more")
    indices = [index - 1 if index > 0 else so_far + index for index in named]
    if 0 in named or min(indices) < 0:
        raise _malformed(what, number, "a face uses a vertex before the first")
    if max(indices) >= _INDEX_MAX:
        raise _malformed(what, number, f"a face uses vertex {max(named)}, which no file has")
    return indices


def _malformed(what: str, number: int, fact: str) -> InputError:
    return InputError(f"{what}, line {number}: {fact}.", "Export the model again.")
