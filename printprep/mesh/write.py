"""A manifold as STL, OBJ or PLY, the same bytes for the same triangles.

These formats carry geometry only; print settings go into the 3MF.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import OutputError
from printprep.mesh.measure import arrays

if TYPE_CHECKING:
    from collections.abc import Callable

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


# Must not begin with "solid": readers take that for ASCII.
_STL_HEADER = b"printprep binary STL, unit mm, z up".ljust(80, b" ")


def to_bytes(manifold: Manifold, suffix: str) -> bytes:
    """The file's content for a suffix of .stl (binary, float32), .obj (text) or .ply (binary,
    float64); coordinates in mm.

    Raises OutputError for another suffix.
    """
    writer = _WRITERS.get(suffix.lower())
    if writer is None:
        raise OutputError(
            f"{suffix or 'A name without suffix'} is no format that can be written here.",
            f"Use .3mf, or one of {', '.join(_WRITERS)}.",
        )
    return writer(*arrays(manifold))


def _stl(vertices: Float, faces: Int) -> bytes:
    record = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    records = np.zeros(len(faces), dtype=record)
    records["normal"] = normals / np.where(length > 0, length, 1.0)
    records["corners"] = corners
    return _STL_HEADER + len(faces).to_bytes(4, "little") + records.tobytes()


def _obj(vertices: Float, faces: Int) -> bytes:
    lines = ["# printprep, unit mm, z up"]
    # repr is the shortest text that reads back to the same float64.
    lines += [f"v {x!r} {y!r} {z!r}" for x, y, z in vertices.tolist()]
    lines += [f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist()]
    return ("\n".join(lines) + "\n").encode("ascii")


def _ply(vertices: Float, faces: Int) -> bytes:
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
