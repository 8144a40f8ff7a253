"""From a file to triangles in mm: every format, every unit, every refusal.

STL and OBJ are read by readers of our own (they say what is wrong and where), PLY and GLB by
trimesh, 3MF by our own strict-on-safety reader.  Whatever the source, what comes out is welded,
finite, in millimetres and z-up.
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
from printprep.mesh.obj import read_obj
from printprep.mesh.stl import read_stl
from printprep.mesh.weld import weld

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


SUFFIXES = (".stl", ".obj", ".ply", ".glb", ".gltf", ".3mf")
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

# glTF 2.0, 3.6.1: "+Y up"; here z is up, so y → z and z → −y (a quarter turn about x).
_GLTF_TO_Z_UP = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)), dtype=np.float64)

# What trimesh's readers raise on a file they cannot make sense of.
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
    """Triangles of a file in mm and z-up, welded, where the file put them.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64;  name : the file's stem.
    from_file : (4, 4) float64, coordinates in the file (its unit, its axes) → ``vertices``.
    up_hint : "+y" when the format itself says that y is up (already turned here), else None.
    """

    vertices: Float
    faces: Int
    name: str
    from_file: Float
    up_hint: str | None = None


def read_mesh(path: Path, units: str | None = None) -> RawMesh:
    """The triangles of ``path``, all bodies of it as one mesh.

    units : mm, cm, m or in, the length one unit of the file stands for.  Without it a 3MF says so
        itself, GLB is in metres by its standard, and everything else is taken for mm.

    Raises
    ------
    InputError : missing, unreadable, not a mesh format, malformed, empty, or with coordinates
        that are not finite.
    UsageError : an unknown unit.
    """
    path = Path(path)
    _check_units(units)
    suffix = path.suffix.lower()
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a file.", "Name the model file inside it.")
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path} is of no format known here: its suffix is {path.suffix or 'missing'}.",
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
    """The same from a ``trimesh.Trimesh`` or ``Scene`` in memory, axes as they are.

    units : as in ``read_mesh``; without it the mesh's own ``units`` if it has any, else mm.

    Raises InputError when it holds no triangles or coordinates that are not finite.
    """
    _check_units(units)
    vertices, faces = _arrays_of(mesh, name)
    mm = MM_PER_UNIT[units] if units else _own_unit_mm(mesh)
    return _raw(vertices, faces, name, mm * np.eye(3), name, None)


def _check_units(units: str | None) -> None:
    if units is not None and units not in MM_PER_UNIT:
        raise UsageError(
            f"--units {units!r} is no unit known here.", f"Use one of {', '.join(MM_PER_UNIT)}."
        )


def _bytes_of(path: Path) -> bytes:
    try:
        data = path.read_bytes()
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Check the name and the folder.") from error
    except OSError as error:
        raise InputError(
            f"{path} cannot be read: {error.strerror or type(error).__name__}.",
            "Check that the file may be read.",
        ) from error
    if not data:
        raise InputError(f"{path} is empty: 0 bytes.", "Export or download the file again.")
    return data


def _through_trimesh(data: bytes, suffix: str, path: Path) -> tuple[Float, Int]:
    import trimesh

    # Only a .gltf needs its neighbours (its buffers); the resolver refuses to leave the folder.
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
            "Export the model again, or in another format.",
        ) from error


def _arrays_of(mesh: Any, what: str) -> tuple[Float, Int]:
    """Vertices and triangles of a trimesh object; a scene's bodies under their transforms."""
    if hasattr(mesh, "to_mesh"):  # a Scene
        mesh = mesh.to_mesh()
    vertices = np.array(getattr(mesh, "vertices", ()), dtype=np.float64).reshape(-1, 3)
    faces = np.array(getattr(mesh, "faces", ()), dtype=np.int64).reshape(-1, 3)
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        raise InputError(f"{what} has a face that names a vertex which does not exist.")
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
            f"The mesh is in {unit!r}, a unit unknown here.",
            f"Set mesh.units, or pass units, one of {', '.join(MM_PER_UNIT)}.",
        ) from error


def _read_3mf(path: Path, units: str | None) -> RawMesh:
    from printprep.threemf.read import read_3mf

    found = read_3mf(path)
    # Its vertices are in mm already; file coordinates are those of its build, in its own unit.
    factor = MM_PER_UNIT[units] / found.unit_mm if units else 1.0
    raw = _raw(found.vertices, found.faces, path.stem, factor * np.eye(3), str(path), None)
    return replace(raw, from_file=raw.from_file @ np.diag([*3 * [found.unit_mm], 1.0]))


def _raw(
    vertices: Float, faces: Int, name: str, linear: Float, what: str, up_hint: str | None
) -> RawMesh:
    """Check, convert by the 3×3 ``linear``, and weld."""
    if len(faces) == 0:
        raise InputError(
            f"{what} holds no triangles.", "Export the surface of the model, not its outline."
        )
    used = vertices[np.unique(faces)]
    bad = int((~np.isfinite(used)).any(axis=1).sum())
    if bad:
        raise InputError(
            f"{what} has {bad} corner{'s' if bad > 1 else ''} whose coordinates are not finite "
            "numbers (NaN or infinite).",
            "Repair or export the model again.",
        )
    from_file = np.eye(4)
    from_file[:3, :3] = linear
    welded, kept = weld(vertices, faces)
    if len(kept) == 0:
        raise InputError(
            f"{what} holds no triangles: the corners of each coincide.",
            "Check the units and the precision it was exported with.",
        )
    return RawMesh(welded @ linear.T, kept, name, from_file, up_hint)


def _one_line(error: BaseException) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    return text[:160].rstrip(".")
