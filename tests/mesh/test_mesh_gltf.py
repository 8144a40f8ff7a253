"""glTF that promises more than it has: textures, instances, counts, nesting, files beside it."""

from __future__ import annotations

import json
import os
import struct
import sys
import time
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from printprep.errors import InputError
from printprep.mesh.measure import signed_volumes
from printprep.mesh.read import read_mesh

CORNERS = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], dtype="<f4")
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]], dtype="<u2")
CONTENT = FACES.tobytes() + CORNERS.tobytes()


def header(**changed: Any) -> dict[str, Any]:
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 12, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 24},
            {"buffer": 0, "byteOffset": 24, "byteLength": 48},
        ],
        "buffers": [{"byteLength": len(CONTENT)}],
        **changed,
    }


def glb(text: bytes, content: bytes = CONTENT) -> bytes:
    text += b" " * (-len(text) % 4)
    content += b"\0" * (-len(content) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(content), b"BIN\0") + content
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def read(folder: Path, content: bytes, name: str = "a.glb"):
    path = folder / name
    path.write_bytes(content)
    return read_mesh(path, "mm")


def png(side: int) -> bytes:
    """A black picture, which unpacks to a thousand times its size."""
    rows = zlib.compress(bytes(side * (side * 3 + 1)), 9)
    chunks = [
        (b"IHDR", struct.pack(">IIBBBBB", side, side, 8, 2, 0, 0, 0)),
        (b"IDAT", rows),
        (b"IEND", b""),
    ]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def test_textures_are_never_decoded(tmp_path: Path) -> None:
    """The picture is damaged: a reader that decodes it would say so, or take its memory."""
    picture = png(4000)[:-30]
    views = header()["bufferViews"]
    views.append({"buffer": 0, "byteOffset": len(CONTENT), "byteLength": len(picture)})
    mesh = {"primitives": [{"attributes": {"POSITION": 1}, "indices": 0, "material": 0}]}
    text = header(
        meshes=[mesh],
        bufferViews=views,
        buffers=[{"byteLength": len(CONTENT) + len(picture)}],
        images=[{"bufferView": 2, "mimeType": "image/png"}],
        textures=[{"source": 0}],
        materials=[{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}],
    )
    began = time.process_time()
    raw = read(tmp_path, glb(json.dumps(text).encode(), CONTENT + picture))
    assert time.process_time() - began < 1.0
    assert signed_volumes(raw.vertices[raw.faces]).sum() == pytest.approx(8 / 6)
    assert [note.kind for note in raw.notes] == ["colours-lost"]


PACKED = "KHR_draco_mesh_compression"
HUGE = {"componentType": 5126, "count": 10**12, "type": "VEC3"}
VIRTUAL = {"componentType": 5126, "count": 14_000_000, "type": "VEC3"}


@pytest.mark.parametrize(
    ("text", "fact"),
    [
        (b"[" * 100_000, "GLB"),
        (b'{"asset":' * 50_000, "GLB"),
        (json.dumps(header(accessors=[HUGE, HUGE])).encode(), "count that no model has"),
        (json.dumps(header(accessors=[VIRTUAL, VIRTUAL])).encode(), "more numbers than it has"),
        (json.dumps(header(nodes=[{"mesh": 0}] * 150_000)).encode(), "150000 nodes"),
        (json.dumps(header(extensionsRequired=[PACKED])).encode(), "packed with Draco"),
        (json.dumps(header(meshes=[{"primitives": 5}])).encode(), "GLB"),
        (json.dumps(header(accessors={})).encode(), "GLB"),
        (b"5", "not an object"),
        (b"", "GLB"),
    ],
)
def test_what_a_header_promises_is_compared_first(tmp_path: Path, text: bytes, fact: str) -> None:
    began = time.process_time()
    with pytest.raises(InputError, match=fact) as caught:
        read(tmp_path, glb(text))
    assert len(caught.value.message) < 400
    assert time.process_time() - began < 2.0


def test_instances_that_multiply_are_refused(tmp_path: Path) -> None:
    count = 99_000
    indices = np.resize(FACES.ravel(), count * 3).astype("<u2").tobytes()
    text = header(
        nodes=[{"mesh": 0}] * 100,
        scenes=[{"nodes": list(range(100))}],
        accessors=[
            {"bufferView": 0, "componentType": 5123, "count": count * 3, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
        ],
        bufferViews=[
            {"buffer": 0, "byteOffset": 0, "byteLength": len(indices)},
            {"buffer": 0, "byteOffset": len(indices), "byteLength": 48},
        ],
        buffers=[{"byteLength": len(indices) + 48}],
    )
    with pytest.raises(InputError, match="9900000 triangles; at most 5000000"):
        read(tmp_path, glb(json.dumps(text).encode(), indices + CORNERS.tobytes()))


@pytest.mark.skipif(sys.platform == "win32", reason="has no pipes in folders")
def test_buffers_beside_a_gltf_are_plain_files_of_its_folder(tmp_path: Path) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    (inner / "well.bin").write_bytes(CONTENT)
    (tmp_path / "outside.bin").write_bytes(CONTENT)
    os.mkfifo(inner / "pipe.bin")
    (inner / "zero.bin").symlink_to("/dev/zero")
    (inner / "link.bin").symlink_to(tmp_path / "outside.bin")

    def with_buffer(uri: str) -> bytes:
        return json.dumps(header(buffers=[{"byteLength": len(CONTENT), "uri": uri}])).encode()

    assert len(read(inner, with_buffer("well.bin"), "a.gltf").faces) == 4
    for uri in ("pipe.bin", "zero.bin", "link.bin", "../outside.bin", "/dev/zero", "none.bin"):
        with pytest.raises(InputError):
            read(inner, with_buffer(uri), "a.gltf")


def test_corners_of_two_coordinates_are_refused(tmp_path: Path) -> None:
    accessors = header()["accessors"]
    accessors[1]["type"] = "VEC2"
    with pytest.raises(InputError):
        read(tmp_path, glb(json.dumps(header(accessors=accessors)).encode()))
