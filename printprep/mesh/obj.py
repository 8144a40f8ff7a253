"""Reads Wavefront OBJ: positions and faces only.

printprep has its own reader because trimesh drops faces it cannot use, takes index 0 for the last
vertex and opens the material files that a model names; and because an error names the line.
Format: Wavefront, "Object Files (.obj)", Advanced Visualizer manual, appendix B1.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from printprep.arrays import Float, Int


def read_obj(data: bytes, what: str) -> tuple[Float, Int]:
    """Vertices (n, 3) float64 in the file's unit and triangles (m, 3) int64 into them.

    what : the file's name in errors.  A polygon becomes a fan of triangles from its first corner.
    Vertex colours, texture coordinates, normals, groups, lines and curves are ignored.

    Raises
    ------
    InputError : a vertex that is not three numbers, a face with fewer than three corners, or a
        corner that does not exist; the message names the line.
    """
    vertices: list[tuple[float, float, float]] = []
    faces: list[tuple[int, int, int]] = []
    lines: list[int] = []  # of each triangle: a face may name a vertex that comes later
    for number, line in _lines(data):
        words = line.partition("#")[0].split()
        if not words:
            continue
        if words[0] == "v":
            vertices.append(_vertex(words, what, number))
        elif words[0] == "f":
            corners = _corners(words, len(vertices), what, number)
            for b, c in pairwise(corners[1:]):
                faces.append((corners[0], b, c))
                lines.append(number)
    triangles = np.array(faces, dtype=np.int64).reshape(-1, 3)
    beyond = np.flatnonzero((triangles >= len(vertices)).any(axis=1))
    if len(beyond):
        raise _malformed(
            what,
            lines[int(beyond[0])],
            f"a face uses vertex {int(triangles[beyond[0]].max()) + 1}, the file has "
            f"{len(vertices)}",
        )
    return np.array(vertices, dtype=np.float64).reshape(-1, 3), triangles


def _lines(data: bytes) -> Iterator[tuple[int, str]]:
    """Lines with their numbers; a line that ends in a backslash is joined with the next."""
    # Latin-1 decodes every byte; only names can hold more than ASCII, and they are not used.
    text = data.decode("latin-1").replace("\r\n", "\n").replace("\r", "\n")
    begun = ""
    for number, line in enumerate(text.split("\n"), start=1):
        if line.endswith("\\"):
            begun += line[:-1] + " "
        else:
            yield number, begun + line
            begun = ""


def _vertex(words: list[str], what: str, number: int) -> tuple[float, float, float]:
    try:
        return float(words[1]), float(words[2]), float(words[3])
    except (ValueError, IndexError) as error:
        raise _malformed(what, number, "a vertex is not three numbers") from error


def _corners(words: list[str], so_far: int, what: str, number: int) -> list[int]:
    """Zero-based vertex indices of a face; negative numbers in the file count from the last."""
    try:
        named = [int(word.partition("/")[0]) for word in words[1:]]
    except ValueError as error:
        raise _malformed(what, number, "a corner of a face is not a whole number") from error
    if len(named) < 3:
        raise _malformed(what, number, f"a face has {len(named)} corners, it needs three or more")
    indices = [index - 1 if index > 0 else so_far + index for index in named]
    if 0 in named or min(indices) < 0:
        raise _malformed(what, number, "a face uses a vertex before the first")
    return indices


def _malformed(what: str, number: int, fact: str) -> InputError:
    return InputError(f"{what}, line {number}: {fact}.", "Export the model again.")
