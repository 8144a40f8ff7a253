"""Meshes as compact bytes for a page: quantized, in an order that packs well, deflated.

A mesh is written as three streams, one after another:

  positions   for each axis the 16-bit steps of all vertices, each as the zigzag difference from the
              vertex before it, all low bytes first, then all middle and all high bytes
  thickness   (only where it was measured) 16-bit hundredths of a millimetre, likewise
  triangles   for a triangle (a, b, c) the zigzag differences a − (a of the triangle before), b − a,
              c − a, as variable-length integers (LEB128)

Vertices follow a Morton curve and triangles their first corner, so that differences are small.  The
viewer reads it back in ``web/src/decode.js``.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Float, Int

    Bytes = NDArray[np.uint8]

STEPS = 65535  # along the longest side of all that the page shows
THICKNESS_STEP_MM = 0.01
UNMEASURED = 65535
_LEVEL = 9


@dataclass(frozen=True, eq=False)
class ViewMesh:
    """A mesh as a page shows it.

    vertices : (n, 3) mm;  faces : (m, 3);  classes : (m,) index of each triangle's layer in
    ``layers``;  thickness_mm : (n,), NaN where none was measured, or None.
    """

    name: str
    vertices: Float
    faces: Int
    classes: Int
    layers: tuple[str, ...]
    thickness_mm: Float | None = None


@dataclass(frozen=True)
class Encoded:
    """Meshes as text for a page: their directory as plain values, and their bytes as base64."""

    directory: dict[str, Any]
    base64: str


def encode(meshes: Sequence[ViewMesh]) -> Encoded:
    """All meshes of a page on one grid of 65536 steps along the longest side.

    The same meshes give the same text.
    """
    points = np.concatenate([mesh.vertices for mesh in meshes])
    low = points.min(axis=0)
    span = float(np.ptp(points, axis=0).max()) or 1.0
    step = span / STEPS
    directory, chunks = [], []
    for mesh in meshes:
        entry, content = _encoded(mesh, low, step)
        directory.append(entry)
        chunks.append(content)
    packed = zlib.compress(b"".join(chunks), _LEVEL)
    head = {
        "origin": [float(value) for value in low],
        "step": step,
        "thicknessStep": THICKNESS_STEP_MM,
        "meshes": directory,
    }
    return Encoded(head, base64.b64encode(packed).decode("ascii"))


def _encoded(mesh: ViewMesh, low: Float, step: float) -> tuple[dict[str, Any], bytes]:
    steps = np.rint((mesh.vertices - low) / step).astype(np.int64)
    order = np.argsort(_morton(steps), kind="stable")
    place = np.empty(len(order), dtype=np.int64)
    place[order] = np.arange(len(order))
    faces = place[mesh.faces]
    first = faces.argmin(axis=1)[:, None]
    faces = np.take_along_axis(faces, (first + np.arange(3)) % 3, axis=1)
    sort = np.lexsort((faces[:, 2], faces[:, 1], faces[:, 0], mesh.classes))
    faces, classes = faces[sort], mesh.classes[sort]
    streams = [_halves(_zigzag(np.diff(steps[order, axis], prepend=0))) for axis in range(3)]
    if mesh.thickness_mm is not None:
        streams.append(_halves(_zigzag(np.diff(_hundredths(mesh.thickness_mm)[order], prepend=0))))
    start = np.diff(faces[:, 0], prepend=0)
    triangles = np.column_stack([start, faces[:, 1] - faces[:, 0], faces[:, 2] - faces[:, 0]])
    streams.append(_varints(_zigzag(triangles.ravel())))
    content = b"".join(streams)
    counts = np.bincount(classes, minlength=len(mesh.layers))
    entry = {
        "name": mesh.name,
        "vertices": len(steps),
        "triangles": len(faces),
        "bytes": len(content),
        "thickness": mesh.thickness_mm is not None,
        "layers": [
            {"name": name, "triangles": int(count)}
            for name, count in zip(mesh.layers, counts, strict=True)
        ],
    }
    return entry, content


def _hundredths(thickness_mm: Float) -> Int:
    """(n,) thickness in steps; unmeasured where it is not finite or too large to hold."""
    steps = np.rint(thickness_mm / THICKNESS_STEP_MM)
    fine = np.isfinite(steps) & (steps < UNMEASURED)
    result: Int = np.where(fine, steps, UNMEASURED).astype(np.int64)
    return result


def _zigzag(values: Int) -> Int:
    """Small magnitudes as small positive numbers: 0, −1, 1, −2, 2 … → 0, 1, 2, 3, 4 …"""
    result: Int = np.where(values < 0, -2 * values - 1, 2 * values)
    return result


def _halves(values: Int) -> bytes:
    """Numbers below 2**24 as all low bytes, then all middle bytes, then all high bytes."""
    planes = [((values >> shift) & 255).astype(np.uint8).tobytes() for shift in (0, 8, 16)]
    return b"".join(planes)


def _varints(values: Int) -> bytes:
    """Numbers below 2**28 as LEB128: seven bits a byte, the high bit set where more follow."""
    groups = np.column_stack([(values >> shift) & 127 for shift in (0, 7, 14, 21)])
    more = np.column_stack([values >> shift > 0 for shift in (7, 14, 21, 28)])
    used = np.column_stack([np.ones(len(values), dtype=bool), more[:, :3]])
    packed: Bytes = (groups | (more << 7)).astype(np.uint8)
    return bytes(packed[used])


def _morton(steps: Int) -> Int:
    """(n,) places on a Morton curve of points (n, 3) of 16 bits an axis."""
    key = np.zeros(len(steps), dtype=np.int64)
    for axis in range(3):
        key |= _spread(steps[:, axis]) << axis
    return key


def _spread(values: Int) -> Int:
    """16-bit numbers with two zero bits after every bit."""
    wide = values.astype(np.int64)
    for shift, mask in (
        (16, 0x0000FF0000FF),
        (8, 0x00F00F00F00F),
        (4, 0x0C30C30C30C3),
        (2, 0x249249249249),
    ):
        wide = (wide | wide << shift) & mask
    return wide
