"""Writes the text of XML parts: escaped strings, and lines of vertices and triangles.

Source: XML 1.0 (fifth edition) sections 2.2 and 3.3.3; 3MF core specification 1.3, ST_Number.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

# All characters outside the Char production; also tab and line ends, which become spaces in
# attributes.
_FORBIDDEN = re.compile("[^\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_ESCAPES = str.maketrans({"&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;", "'": "&apos;"})


def clean(text: str) -> str:
    """`text` without the characters that XML 1.0 forbids; line ends and tabs become spaces."""
    return _FORBIDDEN.sub("", re.sub(r"[\t\r\n]+", " ", text))


def escape(text: str) -> str:
    """`text` as it can stand in an attribute or an element."""
    return clean(text).translate(_ESCAPES)


def vertex_lines(vertices_mm: Float) -> bytes:
    """One <vertex/> a line for vertices (n, 3): the shortest text of each value's float32.

    Slicers keep float32, so this loses nothing that a slicer keeps, and the text reads back as the
    same float32.
    """
    values = vertices_mm.astype(np.float32).ravel() + np.float32(0.0)  # −0 becomes 0
    texts = [text.removesuffix(b".0") for text in values.astype("S").tolist()]
    return b'     <vertex x="%b" y="%b" z="%b"/>\n' * len(vertices_mm) % tuple(texts)


def triangle_lines(
    faces: Int, first_vertex: int, attributes: Sequence[bytes] | None = None
) -> bytes:
    """One <triangle/> a line for faces (m, 3), with `first_vertex` added to each index.

    attributes : what stands in each element after its corners, None for nothing in any.
    """
    if attributes is not None:
        rows = (faces + first_vertex).tolist()
        return b"".join(
            b'     <triangle v1="%d" v2="%d" v3="%d"%b/>\n' % (*row, more)
            for row, more in zip(rows, attributes, strict=True)
        )
    indices = tuple((faces + first_vertex).ravel().tolist())
    return b'     <triangle v1="%d" v2="%d" v3="%d"/>\n' * len(faces) % indices
