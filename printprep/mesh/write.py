"""Writes a manifold as STL, OBJ or PLY; the same triangles give the same bytes.

These formats carry geometry only; a 3MF carries print settings too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import OutputError
from printprep.mesh.measure import area_normals, arrays

if TYPE_CHECKING:
    from collections.abc import Callable

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


# It must not begin with "solid": readers take such a file for ASCII.
_STL_HEADER = b"printprep binary STL, unit mm, z up".ljust(80, b" ")


def to_bytes(manifold: Manifold, suffix: str) -> bytes:
    """The content of a file in mm: .stl (binary, float32), .obj (text) or .ply (binary, float64).

    Raises OutputError for another suffix.
    """
    writer = _WRITERS.get(suffix.lower())
    if writer is None:
        raise OutputError(
            f"{suffix or 'A name without suffix'} is not a format that printprep writes.",
            f"Use .3mf, or one of {', '.join(_WRITERS)}.",
        )
    return writer(*arrays(manifold))


def _stl(vertices: Float, faces: Int) -> bytes:
    """Binary STL of vertices (n, 3) mm and faces (m, 3)."""
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = vertices[faces]
    normals = area_normals(corners)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(faces), dtype=record)
    records["normal"] = normals / np.where(length > 0, length, 1.0)
    records["corners"] = corners
    return _STL_HEADER + len(faces).to_bytes(4, "little") + records.tobytes()


def _obj(vertices: Float, faces: Int) -> bytes:
    """OBJ text of vertices (n, 3) mm and faces (m, 3)."""
    lines = ["# printprep, unit mm, z up"]
    # repr is the shortest text that reads back as the same float64.
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")


def _ply(vertices: Float, faces: Int) -> bytes:
    """Binary PLY of vertices (n, 3) mm and faces (m, 3)."""
    header = (
        "ply\nformat binary_little_endian 1.0\ncomment printprep, unit mm, z up\n"
        f"element vertex {len(vertices)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    rows = np.zeros(len(faces), dtype=np.dtype([("count", "u1"), ("corners", "<i4", 3)]))
    rows["count"] = 3
    rows["corners"] = faces
    return header.encode("ascii") + vertices.astype("<f8").tobytes() + rows.tobytes()


_WRITERS: dict[str, Callable[[Float, Int], bytes]] = {".stl": _stl, ".obj": _obj, ".ply": _ply}
