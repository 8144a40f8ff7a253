"""The mesh of an object as lines of XML: volumes one after another, in one list of vertices."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from printprep.threemf.xml_text import triangle_lines, vertex_lines

if TYPE_CHECKING:
    from printprep.threemf.item import Volume
    from printprep.threemf.painting import Painter


def mesh_lines(volumes: Sequence[Volume], painter: Painter) -> Iterator[bytes]:
    """The element <mesh> of volumes; each keeps its own range of vertices and triangles."""
    yield b"   <mesh>\n    <vertices>\n"
    for volume in volumes:
        yield vertex_lines(volume.vertices)
    yield b"    </vertices>\n    <triangles>\n"
    first = 0
    for volume in volumes:
        yield triangle_lines(volume.faces, first, painter.attributes(volume))
        first += len(volume.vertices)
    yield b"    </triangles>\n   </mesh>\n"
