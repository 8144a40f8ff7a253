"""Reads glTF and GLB with trimesh, after what the file promises was compared with limits.

Materials and textures are never decoded: a texture of 400 KB can unpack to gigabytes.  Format:
Khronos, "glTF 2.0", sections 3.6 (accessors), 3.7 (meshes) and 3.5 (nodes).
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import InputError, PrintprepError
from printprep.input_file import read_plain_file
from printprep.mesh.limits import TRIANGLES_MAX, refuse_too_many
from printprep.types import ReadNote
from printprep.wording import shortened

if TYPE_CHECKING:
    from printprep.arrays import Float, Int

_TRIANGLES, _STRIP = 4, (5, 6)
_NODES_MAX = 100_000
_PACKED = {"KHR_draco_mesh_compression": "Draco", "EXT_meshopt_compression": "meshopt"}
# What a header that is not as the standard says can raise where it is compared with limits.
_ODD = (AttributeError, LookupError, RecursionError, TypeError, ValueError, struct.error)


@dataclass(frozen=True, eq=False)
class GltfMesh:
    """What a scene holds, its bodies placed.

    vertices : (n, 3) float64 in metres, y up;  faces : (m, 3) int64;  notes : as in ReadNote.
    """

    vertices: Float
    faces: Int
    notes: tuple[ReadNote, ...] = ()


def read_gltf(data: bytes, suffix: str, path: Path) -> GltfMesh:
    """The triangles of a .glb or .gltf file, whose content is ``data``.

    Raises InputError for a file that is damaged, packed, or larger than printprep works on.
    """
    from printprep.mesh.from_trimesh import arrays_of

    try:
        notes = _checked(_header(data, suffix), path)
    except _ODD as error:
        raise _unreadable(path, suffix, error) from error
    try:
        with np.errstate(all="ignore"):
            vertices, faces = arrays_of(_scene(data, suffix, path), str(path))
    except PrintprepError:
        raise
    except Exception as error:  # trimesh raises whatever a damaged file leads it to
        raise _unreadable(path, suffix, error) from error
    return GltfMesh(vertices, faces, notes)


def _unreadable(path: Path, suffix: str, error: Exception) -> InputError:
    text = " ".join(str(error).split()) or type(error).__name__
    return InputError(
        f"{path} cannot be read as {suffix[1:].upper()}: {shortened(text, 160).rstrip('.')}.",
        "Export the model again, or export it in another format.",
    )


def _scene(data: bytes, suffix: str, path: Path) -> Any:
    import trimesh

    class Beside(trimesh.resolvers.FilePathResolver):  # type: ignore[misc]
        """Buffers of a .gltf: plain files of its own folder, within the limit of any input."""

        def get(self, name: str) -> bytes:
            buffer = (path.parent / name).resolve()
            if not buffer.is_relative_to(path.parent.resolve()):
                raise ValueError(f"it names the file {shortened(name)} outside its folder")
            return read_plain_file(buffer)

    resolver = Beside(str(path)) if suffix == ".gltf" else None
    return trimesh.load_scene(
        io.BytesIO(data),
        file_type=suffix[1:],
        resolver=resolver,
        process=False,
        skip_materials=True,
    )


def _header(data: bytes, suffix: str) -> Mapping[str, Any]:
    text = data
    if suffix == ".glb":
        if len(data) < 20 or data[:4] != b"glTF":
            raise ValueError("it does not begin with 'glTF'")
        length, kind = struct.unpack_from("<I4s", data, 12)
        if kind != b"JSON" or 20 + length > len(data):
            raise ValueError("its first chunk is not whole")
        text = data[20 : 20 + length]
    header = json.loads(text.decode("utf-8-sig"))
    if not isinstance(header, dict):
        raise ValueError("its JSON is not an object")
    return header


def _checked(header: Mapping[str, Any], path: Path) -> tuple[ReadNote, ...]:
    """Compare what a file promises with the limits; return what it has that is not read."""
    for name in header.get("extensionsRequired") or ():
        if name in _PACKED:
            raise InputError(
                f"{path} is packed with {_PACKED[name]}, which printprep does not unpack.",
                "Export it without compression.",
            )
    accessors = [item["count"] for item in header.get("accessors", ())]
    if not all(isinstance(count, int) and 0 <= count <= 3 * TRIANGLES_MAX for count in accessors):
        raise ValueError("it has an accessor with a count that no model has")
    virtual = sum(item["count"] for item in header.get("accessors", ()) if "bufferView" not in item)
    if virtual > 3 * TRIANGLES_MAX:
        raise ValueError("it promises more numbers than it has")
    corners, triangles, coloured = [], [], False
    for mesh in header.get("meshes", ()):
        corners.append(0)
        triangles.append(0)
        for primitive in mesh["primitives"]:
            positions = accessors[primitive["attributes"]["POSITION"]]
            count = accessors[primitive["indices"]] if "indices" in primitive else positions
            mode = primitive.get("mode", _TRIANGLES)
            triangles[-1] += count // 3 if mode == _TRIANGLES else count if mode in _STRIP else 0
            corners[-1] += positions
            coloured = coloured or "COLOR_0" in primitive["attributes"]
    nodes = header.get("nodes", ())
    if len(nodes) > _NODES_MAX:
        raise ValueError(f"it has {len(nodes)} nodes")
    placed = [node["mesh"] for node in nodes if node.get("mesh") is not None]
    refuse_too_many(sum(triangles[mesh] for mesh in placed), str(path))
    if sum(corners[mesh] for mesh in placed) > 3 * TRIANGLES_MAX:
        raise ValueError("it places more corners than printprep works on")
    if not coloured and not header.get("textures") and len(header.get("materials", ())) < 2:
        return ()
    return (
        ReadNote(
            "colours-lost",
            f"The colours and textures of the {path.suffix[1:].upper()} file are not read: the "
            "part has none.",
            "Save the model as a 3MF with its colours to keep them on the outside.",
        ),
    )
