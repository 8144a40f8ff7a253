"""Files whose content is of another format than their suffix says."""

from __future__ import annotations

import gzip
import io
import zipfile
from pathlib import Path

import pytest
import trimesh

from printprep.errors import InputError
from printprep.mesh.read import read_mesh

BOX = trimesh.creation.box((10.0, 20.0, 30.0))


def exported(kind: str) -> bytes:
    data = BOX.export(file_type=kind)
    return data if isinstance(data, bytes) else data.encode()


def zipped(name: str) -> bytes:
    memory = io.BytesIO()
    with zipfile.ZipFile(memory, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, exported("stl"))
    return memory.getvalue()


CASES = {
    "zip.stl": (zipped("model.stl"), "a ZIP archive", "Unpack it"),
    "gzip.ply": (gzip.compress(exported("ply")), "a gzip archive", "Unpack it"),
    "gzip.3mf": (gzip.compress(exported("stl")), "a gzip archive", "Unpack it"),
    "7z.obj": (b"7z\xbc\xaf\x27\x1c" + bytes(99), "a 7z archive", "Unpack it"),
    "3mf.stl": (zipped("3D/3dmodel.model"), "a 3MF file", "suffix .3mf"),
    "glb.stl": (exported("glb"), "a GLB file", "suffix .glb"),
    "glb.gltf": (exported("glb"), "a GLB file", "suffix .glb"),
    "ply.stl": (exported("ply"), "a PLY file", "suffix .ply"),
    "text.obj": (exported("stl_ascii"), "an STL file", "suffix .stl"),
    "binary.3mf": (exported("stl"), "an STL file", "suffix .stl"),
    "step.stl": (b"ISO-10303-21;\nHEADER;\n", "a STEP file", "export it as STL"),
    "page.stl": (b"\n<!DOCTYPE HTML>\n<title>404</title>", "a web page", "Download the model"),
    "picture.3mf": (b"\x89PNG\r\n\x1a\n" + bytes(99), "a picture", "file of the model"),
}


@pytest.mark.parametrize("name", CASES)
def test_another_format_is_told_as_what_it_is(tmp_path: Path, name: str):
    data, format_name, way_out = CASES[name]
    path = tmp_path / name
    path.write_bytes(data)
    with pytest.raises(InputError) as caught:
        read_mesh(path)
    assert f"{name} is {format_name}, not what its suffix" in caught.value.message
    assert caught.value.hint is not None and way_out in caught.value.hint


@pytest.mark.parametrize("begins", [b"PK\x03\x04", b"ply\n", b"glTF", b"solid", b"<html>"])
def test_the_header_of_a_binary_stl_may_begin_with_anything(tmp_path: Path, begins: bytes):
    data = exported("stl")
    path = tmp_path / "box.stl"
    path.write_bytes(begins + data[len(begins) :])
    assert len(read_mesh(path).faces) == 12
