"""Reads a mesh file of any supported format and unit into triangles in mm.

printprep reads STL, OBJ and 3MF itself (its errors name what is wrong and where), and PLY and GLB
with trimesh.  The result is always welded, finite, in millimetres and with z up.
"""

from __future__ import annotations

import io
import json
import struct
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import InputError, UsageError
from printprep.files import reason_of
from printprep.mesh.obj import read_obj
from printprep.mesh.stl import read_stl
from printprep.mesh.weld import weld
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


SUFFIXES = (".stl", ".obj", ".ply", ".glb", ".gltf", ".3mf")
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

# glTF 2.0, 3.6.1: "+Y up"; here z is up, so y → z and z → −y (a quarter turn about x).
_GLTF_TO_Z_UP = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)), dtype=np.float64)

# Exceptions that trimesh's readers raise on a malformed file.
_UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    ImportError,
    LookupError,
    MemoryError,
    NotImplementedError,
    OSError,
    RecursionError,
    RuntimeError,
    TypeError,
    ValueError,
    struct.error,
    json.JSONDecodeError,
)


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Triangles of a file in mm, z up, welded, at the position that the file gives them.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64;  name : the file's stem.
    from_file : (4, 4) float64, coordinates in the file (its unit, its axes) → ``vertices``.
    up_hint : "+y" where the format defines y as up (``vertices`` are turned already), else None.
    """

    vertices: Float
    faces: Int
    name: str
    from_file: Float
    up_hint: str | None = None


def read_mesh(path: Path, units: str | None = None) -> RawMesh:
    """The triangles of the file ``path``, all its bodies as one mesh.

    units : mm, cm, m or in, the length of one unit of the file.  Without it a 3MF names its unit,
        GLB is in metres by its standard, and all other files are taken to be in mm.

    Raises
    ------
    InputError : the file is missing, unreadable, not a mesh format, malformed or empty, or has
        coordinates that are not finite.
    UsageError : an unknown unit.
    """
    path = Path(path)
    _check_units(units)
    suffix = path.suffix.lower()
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a file.", "Name the model file inside it.")
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path} has an unknown format: its suffix is {path.suffix or 'missing'}.",
            f"Use a mesh with one of {', '.join(SUFFIXES)}.",
        )
    data = _bytes_of(path)
    what = str(path)
    if suffix == ".stl":
        corners = read_stl(data, what)
        vertices, faces = corners.reshape(-1, 3), np.arange(len(corners) * 3).reshape(-1, 3)
    elif suffix == ".obj":
        vertices, faces = read_obj(data, what)
    elif suffix == ".3mf":
        return _read_3mf(path, units)
    else:
        vertices, faces = _through_trimesh(data, suffix, path)
    gltf = suffix in (".glb", ".gltf")
    mm = MM_PER_UNIT[units] if units else (MM_PER_UNIT["m"] if gltf else 1.0)
    turn = _GLTF_TO_Z_UP if gltf else np.eye(3)
    return _raw(vertices, faces, path.stem, mm * turn, what, "+y" if gltf else None)


def from_trimesh(mesh: Any, name: str = "model", units: str | None = None) -> RawMesh:
    """The triangles of a ``trimesh.Trimesh`` or ``Scene``, all bodies as one mesh, axes unchanged.

    units : as in ``read_mesh``; without it the mesh's own ``units`` if it has any, else mm.

    Raises InputError where it holds no triangles, or coordinates that are not finite.
    """
    _check_units(units)
    vertices, faces = _arrays_of(mesh, name)
    mm = MM_PER_UNIT[units] if units else _own_unit_mm(mesh)
    return _raw(vertices, faces, name, mm * np.eye(3), name, None)


def _check_units(units: str | None) -> None:
    if units is not None and units not in MM_PER_UNIT:
        raise UsageError(
            f"--units {units!r} is not a known unit.", f"Use one of {', '.join(MM_PER_UNIT)}."
        )


def _bytes_of(path: Path) -> bytes:
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Check the name and the folder.") from error
    except OSError as error:
        raise InputError(
            f"{path} cannot be read: {reason_of(error)}.",
            "Check that you have permission to read the file.",
        ) from error
    if not data:
        raise InputError(f"{path} is empty: 0 bytes.", "Export or download the file again.")
    return data


def _through_trimesh(data: bytes, suffix: str, path: Path) -> tuple[Float, Int]:
    """Vertices (n, 3) in the file's unit and triangles (m, 3), read by trimesh."""
    import trimesh

    # Only a .gltf needs other files (its buffers); the resolver never leaves the folder.
    resolver = trimesh.resolvers.FilePathResolver(str(path)) if suffix == ".gltf" else None
    try:
        with np.errstate(all="ignore"):
            scene = trimesh.load_scene(
                io.BytesIO(data), file_type=suffix[1:], resolver=resolver, process=False
            )
        return _arrays_of(scene, str(path))
    except _UNREADABLE as error:
        raise InputError(
            f"{path} cannot be read as {suffix[1:].upper()}: {_one_line(error)}.",
            "Export the model again, or export it in another format.",
        ) from error


def _arrays_of(mesh: Any, what: str) -> tuple[Float, Int]:
    """Vertices (n, 3) and triangles (m, 3) of a trimesh object; a scene's bodies are placed."""
    if hasattr(mesh, "to_mesh"):  # a Scene
        mesh = mesh.to_mesh()
    vertices = np.array(getattr(mesh, "vertices", ()), dtype=np.float64).reshape(-1, 3)
    faces = np.array(getattr(mesh, "faces", ()), dtype=np.int64).reshape(-1, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise InputError(
            f"{what} has a face that uses a vertex which does not exist.",
            "Export the model again, or export it in another format.",
        )
    return vertices, faces


def _own_unit_mm(mesh: Any) -> float:
    unit = getattr(mesh, "units", None)
    if unit is None:
        return 1.0
    import trimesh

    try:
        return float(trimesh.units.unit_conversion(unit, "mm"))
    except (KeyError, ValueError) as error:
        raise InputError(
            f"The unit of the mesh, {unit!r}, is not known.",
            f"Set mesh.units, or pass units, to one of {', '.join(MM_PER_UNIT)}.",
        ) from error


def _read_3mf(path: Path, units: str | None) -> RawMesh:
    from printprep.threemf.read import read_3mf

    found = read_3mf(path)
    # The vertices are in mm already; file coordinates are those of the build, in the file's unit.
    factor = MM_PER_UNIT[units] / found.unit_mm if units else 1.0
    raw = _raw(found.vertices, found.faces, path.stem, factor * np.eye(3), str(path), None)
    return replace(raw, from_file=raw.from_file @ np.diag([*3 * [found.unit_mm], 1.0]))


def _raw(
    vertices: Float, faces: Int, name: str, linear: Float, what: str, up_hint: str | None
) -> RawMesh:
    """Check, convert and weld vertices (n, 3) in the file's unit and faces (m, 3).

    linear : (3, 3), the file's unit and axes → mm and z up.
    """
    if len(faces) == 0:
        raise InputError(
            f"{what} holds no triangles.", "Export the surface of the model, not its outline."
        )
    used = vertices[np.unique(faces)]
    bad = int((~np.isfinite(used)).any(axis=1).sum())
    if bad:
        raise InputError(
            f"{what} has {counted(bad, 'corner')} whose coordinates are not finite numbers (NaN "
            "or infinite).",
            "Repair or export the model again.",
        )
    from_file = np.eye(4)
    from_file[:3, :3] = linear
    welded, kept = weld(vertices, faces)
    if len(kept) == 0:
        raise InputError(
            f"{what} holds no triangles with three different corners.",
            "Check the units and the precision of the export.",
        )
    return RawMesh(welded @ linear.T, kept, name, from_file, up_hint)


def _one_line(error: BaseException) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    return text[:160].rstrip(".")
