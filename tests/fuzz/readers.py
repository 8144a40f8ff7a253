"""Every reader of files that strangers send: what it is given, and a few small files that are well.

The byte fuzz of the tests and the harness for atheris share this list.
"""

from __future__ import annotations

import functools
import io
import json
import struct
import tempfile
import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from printprep.errors import PrintprepError


@dataclass(frozen=True)
class Reader:
    """One reader.

    suffix : of the file;  read : reads it;  seeds : contents that it takes.
    pack : makes the file of a content: in an archive every changed byte would only break the
    checksum.
    """

    suffix: str
    read: Callable[[Path], object]
    seeds: tuple[bytes, ...]
    pack: Callable[[bytes], bytes] = bytes


def refuses_or_reads(reader: Reader, content: bytes, folder: Path) -> bool:
    """Whether a reader takes a content.  Anything but a refusal of ours is raised."""
    path = folder / f"file{reader.suffix}"
    path.write_bytes(reader.pack(content))
    try:
        reader.read(path)
    except PrintprepError as error:
        assert "\n" not in error.message
        assert len(error.message) < 2000
        return False
    return True


def _mesh(path: Path) -> object:
    from printprep.mesh.read import Choice, read_mesh

    return read_mesh(path, choice=Choice(partial=True))


def _voxels(path: Path) -> object:
    from printprep.generators.model import read_model

    return read_model(path)


def _profile(path: Path) -> object:
    from printprep.profiles import load_profile

    return load_profile(path)


def _part(path: Path) -> object:
    from printprep.verify.part_3mf import computed_part

    return computed_part(path)


def _table(path: Path) -> object:
    import click

    from printprep.cli.batch_table import items_in
    from printprep.cli.part_options import part_options

    @click.command()
    @part_options
    def defaults(**options: object) -> None:
        del options

    given = defaults.make_context("defaults", []).params
    return items_in(path, given, path.parent / "out", ".3mf", "none")


CORNERS = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [0, 0, 2]], dtype=np.float64)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def _binary_stl() -> bytes:
    rows = b"".join(
        struct.pack("<12fH", 0, 0, 0, *CORNERS[face].ravel(), 0) for face in FACES.tolist()
    )
    return b"made by no one".ljust(80) + struct.pack("<I", len(FACES)) + rows


def _text_stl() -> bytes:
    lines = ["solid a name"]
    for face in FACES.tolist():
        corners = [f"vertex {x:g} {y:g} {z:g}" for x, y, z in CORNERS[face].tolist()]
        lines += ["facet normal 0 0 1", "outer loop", *corners, "endloop", "endfacet"]
    return "\n".join([*lines, "endsolid a name", ""]).encode()


def _obj() -> bytes:
    lines = [f"v {x:g} {y:g} {z:g}" for x, y, z in CORNERS.tolist()]
    lines += ["usemtl stone", *(f"f {a + 1}/1 {b + 1}// {c + 1}" for a, b, c in FACES.tolist())]
    return "\n".join([*lines, "f -4 -3 \\", "-2", ""]).encode()


def _ply(order: str) -> bytes:
    name = {"": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
    head = (
        f"ply\nformat {name} 1.0\ncomment TextureFile a.png\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty double z\nelement face 4\n"
        "property list uchar int vertex_indices\nend_header\n"
    ).encode()
    if not order:
        rows = [" ".join(f"{value:g}" for value in row) for row in CORNERS.tolist()]
        rows += [f"3 {a} {b} {c}" for a, b, c in FACES.tolist()]
        return head + "\n".join([*rows, ""]).encode()
    rows_b = b"".join(struct.pack(f"{order}ffd", *row) for row in CORNERS.tolist())
    return head + rows_b + b"".join(struct.pack(f"{order}B3i", 3, *f) for f in FACES.tolist())


def _gltf(binary: bool) -> bytes:
    import base64

    indices = FACES.astype("<u2").tobytes()
    content = indices + CORNERS.astype("<f4").tobytes()
    header: dict[str, object] = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "scale": [2, 2, 2]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 12, "type": "SCALAR"},
            {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC3"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(indices)},
            {"buffer": 0, "byteOffset": len(indices), "byteLength": 48},
        ],
        "buffers": [{"byteLength": len(content)}],
    }
    if not binary:
        uri = "data:application/octet-stream;base64," + base64.b64encode(content).decode()
        header["buffers"] = [{"byteLength": len(content), "uri": uri}]
        return json.dumps(header).encode()
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    chunks += struct.pack("<I4s", len(content), b"BIN\0") + content
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _zip(parts: Mapping[str, bytes], method: int = zipfile.ZIP_STORED) -> bytes:
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", method) as archive:
        for name, content in parts.items():
            archive.writestr(zipfile.ZipInfo(name), content)
    return buffer.getvalue()


def _model_xml() -> bytes:
    vertices = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>' for x, y, z in CORNERS.tolist())
    faces = "".join(
        f'<triangle v1="{a}" v2="{b}" v3="{c}" pid="5" p1="0" paint_color="8"/>'
        for a, b, c in FACES.tolist()
    )
    return (
        '<?xml version="1.0"?><model unit="millimeter" xmlns="http://schemas.microsoft.com/'
        '3dmanufacturing/core/2015/02"><resources><basematerials id="5"><base name="r" '
        'displaycolor="#FF0000"/></basematerials><object id="1" pid="5" pindex="0"><mesh>'
        f"<vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh></object>"
        '<object id="2"><components><component objectid="1" transform="1 0 0 0 1 0 0 0 1 9 0 0"/>'
        '</components></object></resources><build><item objectid="1"/><item objectid="2"/></build>'
        "</model>"
    ).encode()


MODEL, FIGURES = "3D/3dmodel.model", "Metadata/printprep.json"
PRUSA, BAMBU = "Metadata/Slic3r_PE_model.config", "Metadata/model_settings.config"
_PRUSA = (
    b'<config><object id="1"><metadata key="name" value="a"/><volume firstid="0" lastid="3">'
    b'<metadata key="volume_type" value="ModelPart"/></volume></object></config>'
)
_BAMBU = (
    b'<config><object id="2"><part id="1" subtype="normal_part"/></object><plate><metadata '
    b'key="plater_id" value="1"/><model_instance><metadata key="object_id" value="2"/><metadata'
    b' key="instance_id" value="0"/></model_instance></plate></config>'
)


def _projects() -> tuple[bytes, ...]:
    model = {MODEL: _model_xml()}
    return (
        _zip(model),
        _zip({**model, PRUSA: _PRUSA}),
        _zip({**model, BAMBU: _BAMBU}),
        _zip({**model, FIGURES: b'{"format": 1}'}, zipfile.ZIP_DEFLATED),
    )


def _within(name: str) -> Callable[[bytes], bytes]:
    """Makes a 3MF of the content of one of its parts."""
    return lambda content: _zip({MODEL: _model_xml(), name: content})


def _npy() -> bytes:
    buffer = io.BytesIO()
    np.save(buffer, np.array([[1, 2, 3], [1, 2, 4], [2, 2, 3]]))
    return buffer.getvalue()


def _npz() -> bytes:
    return _zip({"coords.npy": _npy(), "other.npy": _npy()})


def _pt() -> bytes:
    import torch

    buffer = io.BytesIO()
    torch.save({"coords": torch.tensor([[0, 1, 2, 3], [0, 1, 2, 4]])}, buffer)
    return buffer.getvalue()


@functools.cache
def _written() -> dict[str, bytes]:
    """The parts of a 3MF that printprep writes."""
    import trimesh

    from printprep import hollow

    made = hollow(trimesh.creation.box((6, 6, 8)), resolution=8)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.3mf"
        made.write(path)
        with zipfile.ZipFile(path) as archive:
            return {name: archive.read(name) for name in archive.namelist()}


def _with_figures(figures: bytes) -> bytes:
    return _zip({**_written(), FIGURES: figures})


def _pickled() -> bytes:
    with zipfile.ZipFile(io.BytesIO(_pt())) as archive:
        return archive.read("archive/data.pkl")


def _pt_of(pickled: bytes) -> bytes:
    """The .pt file with other pickled data in it."""
    with zipfile.ZipFile(io.BytesIO(_pt())) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    return _zip({**parts, "archive/data.pkl": pickled})


def _toml() -> bytes:
    from printprep.profiles import profile_source

    # A short profile: bytes that are comments teach the fuzzer nothing.
    lines = [line.partition("#")[0].rstrip() for line in profile_source("sls-pa12").splitlines()]
    return "\n".join(line for line in lines if line).encode()


READERS: Mapping[str, Callable[[], Reader]] = {
    "stl": lambda: Reader(".stl", _mesh, (_binary_stl(), _text_stl())),
    "obj": lambda: Reader(".obj", _mesh, (_obj(),)),
    "ply": lambda: Reader(".ply", _mesh, (_ply(""), _ply("<"), _ply(">"))),
    "glb": lambda: Reader(".glb", _mesh, (_gltf(True),)),
    "gltf": lambda: Reader(".gltf", _mesh, (_gltf(False),)),
    "3mf": lambda: Reader(".3mf", _mesh, _projects()),
    "part": lambda: Reader(".3mf", _part, _projects()),
    "model": lambda: Reader(".3mf", _mesh, (_model_xml(),), _within(MODEL)),
    "prusa": lambda: Reader(".3mf", _mesh, (_PRUSA,), _within(PRUSA)),
    "bambu": lambda: Reader(".3mf", _mesh, (_BAMBU,), _within(BAMBU)),
    "figures": lambda: Reader(".3mf", _part, (_written()[FIGURES],), _with_figures),
    "npz": lambda: Reader(".npz", _voxels, (_npz(),)),
    "npy": lambda: Reader(".npy", _voxels, (_npy(),)),
    "pt": lambda: Reader(".pt", _voxels, (_pt(),)),
    "pickle": lambda: Reader(".pt", _voxels, (_pickled(),), _pt_of),
    "toml": lambda: Reader(".toml", _profile, (_toml(),)),
    "csv": lambda: Reader(".csv", _table, (b"file,size,lean,set\nfile.csv,80,15,wall_mm=2\n",)),
}
