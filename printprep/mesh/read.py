"""Reads a mesh file of any supported format and unit into triangles in mm.

printprep reads STL, OBJ, PLY and 3MF itself (its errors name what is wrong and where), and GLB with
trimesh.  The result is always welded, finite, in millimetres and with z up.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.errors import InputError, UsageError
from printprep.input_file import check_plain_file, read_plain_file
from printprep.mesh.from_trimesh import arrays_of
from printprep.mesh.gltf import read_gltf
from printprep.mesh.limits import refuse_strays, refuse_too_many
from printprep.mesh.obj import read_obj
from printprep.mesh.ply import read_ply
from printprep.mesh.stl import read_stl
from printprep.mesh.weld import welded
from printprep.mislabelled import refuse_mislabelled
from printprep.types import Paint, ReadNote
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


SUFFIXES = (".stl", ".obj", ".ply", ".glb", ".gltf", ".3mf")
MM_PER_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}

# glTF 2.0, 3.6.1: "+Y up"; here z is up, so y → z and z → −y (a quarter turn about x).
_GLTF_TO_Z_UP = np.array(((1, 0, 0), (0, 0, -1), (0, 1, 0)), dtype=np.float64)


@dataclass(frozen=True)
class Choice:
    """What to take from a file, and how.

    units : mm, cm, m or in, the length of one unit of the file.  Without it a 3MF names its unit,
        GLB is in metres by its standard, and all other files are taken to be in mm.
    partial : take the facets that are there from a file that is cut short.
    plate : number of the plate of a 3MF project;  item : name or number of one object of a 3MF.
    """

    units: str | None = None
    partial: bool = False
    plate: int | None = None
    item: str | None = None


ALL = Choice()


@dataclass(frozen=True, eq=False)
class RawMesh:
    """Triangles of a file in mm, z up, welded, at the position that the file gives them.

    vertices : (n, 3) float64 mm;  faces : (m, 3) int64;  name : the file's stem.
    from_file : (4, 4) float64, coordinates in the file (its unit, its axes) → ``vertices``.
    up_hint : "+y" where the format defines y as up (``vertices`` are turned already), else None.
    notes : what the reader has to say;  paint : colours of the faces, None where there are none.
    blockers : where the file tells a slicer to make no supports, each as vertices (n, 3) in file
    coordinates and faces (m, 3).
    """

    vertices: Float
    faces: Int
    name: str
    from_file: Float
    up_hint: str | None = None
    notes: tuple[ReadNote, ...] = ()
    paint: Paint | None = None
    blockers: tuple[tuple[Float, Int], ...] = ()


def read_mesh(path: Path, units: str | None = None, *, choice: Choice = ALL) -> RawMesh:
    """The triangles of the file ``path``, all its bodies as one mesh.

    choice : what to take from the file;  units : short for ``Choice(units=…)``.

    Raises
    ------
    InputError : the file is missing, unreadable, not a mesh format, malformed, cut short, empty or
        too large, has coordinates that are not finite, or several plates and none is named.
    UsageError : an unknown unit, or a plate or an object that the file does not have.
    """
    path = Path(path)
    choice = choice if units is None else replace(choice, units=units)
    _check_units(choice.units)
    suffix = path.suffix.lower()
    if path.is_dir():
        raise InputError(f"{path} is a folder, not a file.", "Name the model file inside it.")
    if suffix not in SUFFIXES:
        raise InputError(
            f"{path} has an unknown format: its suffix is {path.suffix or 'missing'}.",
            f"Use a mesh with one of {', '.join(SUFFIXES)}.",
        )
    what = str(path)
    if suffix == ".3mf":
        check_plain_file(path)
        return _read_3mf(path, choice)
    refuse_parts(choice, what)
    data = read_plain_file(path)
    refuse_mislabelled(data, suffix, what)
    vertices: Float
    faces: Int
    if suffix == ".stl":
        facets = read_stl(data, what, partial=choice.partial)
        vertices, notes = facets.corners.reshape(-1, 3), facets.notes
        faces = np.arange(len(vertices)).reshape(-1, 3)
    elif suffix == ".obj":
        found = read_obj(data, what)
        vertices, faces, notes = found.vertices, found.faces, found.notes
    elif suffix == ".ply":
        ply = read_ply(data, what, partial=choice.partial)
        vertices, faces, notes = ply.vertices, ply.faces, ply.notes
    else:
        scene = read_gltf(data, suffix, path)
        vertices, faces, notes = scene.vertices, scene.faces, scene.notes
    gltf = suffix in (".glb", ".gltf")
    mm = MM_PER_UNIT[choice.units] if choice.units else (MM_PER_UNIT["m"] if gltf else 1.0)
    turn = _GLTF_TO_Z_UP if gltf else np.eye(3)
    raw = _raw(vertices, faces, path.stem, mm * turn, what, "+y" if gltf else None)
    return replace(raw, notes=notes)


def from_trimesh(mesh: Any, name: str = "model", units: str | None = None) -> RawMesh:
    """The triangles of a ``trimesh.Trimesh`` or ``Scene``, all bodies as one mesh, axes unchanged.

    units : as in ``read_mesh``; without it the mesh's own ``units`` if it has any, else mm.

    Raises InputError where it holds no triangles, or coordinates that are not finite.
    """
    _check_units(units)
    vertices, faces = arrays_of(mesh, name)
    mm = MM_PER_UNIT[units] if units else _own_unit_mm(mesh)
    return _raw(vertices, faces, name, mm * np.eye(3), name, None)


def _check_units(units: str | None) -> None:
    if units is not None and units not in MM_PER_UNIT:
        raise UsageError(
            f"--units {units!r} is not a known unit.", f"Use one of {', '.join(MM_PER_UNIT)}."
        )


def refuse_parts(choice: Choice, what: str) -> None:
    """Raise UsageError for a plate or an object of a file whose format has none."""
    for option, value in (("--plate", choice.plate), ("--object", choice.item)):
        if value is not None:
            raise UsageError(
                f"{option} {value} has no meaning for {what}: only a 3MF has plates and objects.",
                f"Leave out {option}.",
            )


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


def _read_3mf(path: Path, choice: Choice) -> RawMesh:
    from printprep.mesh.subtract import subtracted
    from printprep.threemf.read import read_3mf

    given_mm = None if choice.units is None else MM_PER_UNIT[choice.units]
    found = read_3mf(path, unit_mm=given_mm, plate=choice.plate, item=choice.item)
    # The vertices are in mm already; file coordinates are those of the build, in the file's unit.
    solid = subtracted(found, str(path)) if found.negatives else found
    raw = _raw(solid.vertices, solid.faces, path.stem, np.eye(3), str(path), None, solid.paint)
    from_file = raw.from_file @ np.diag([*3 * [found.unit_mm], 1.0])
    blockers = tuple((one.vertices / found.unit_mm, one.faces) for one in found.blockers)
    return replace(raw, from_file=from_file, notes=found.notes, blockers=blockers)


def _raw(
    vertices: Float,
    faces: Int,
    name: str,
    linear: Float,
    what: str,
    up_hint: str | None,
    paint: Paint | None = None,
) -> RawMesh:
    """Check, convert and weld vertices (n, 3) in the file's unit and faces (m, 3).

    linear : (3, 3), the file's unit and axes → mm and z up.
    """
    if len(faces) == 0:
        raise InputError(
            f"{what} holds no triangles.", "Export the surface of the model, not its outline."
        )
    refuse_too_many(len(faces), what)
    used = np.zeros(len(vertices), dtype=bool)
    used[faces.ravel()] = True
    bad = int((~np.isfinite(vertices).all(axis=1) & used).sum())
    if bad:
        raise InputError(
            f"{what} has {counted(bad, 'corner')} whose coordinates are not finite numbers (NaN "
            "or infinite).",
            "Repair or export the model again.",
        )
    refuse_strays(vertices, faces, what)
    from_file = np.eye(4)
    from_file[:3, :3] = linear
    mesh = welded(vertices, faces)
    if len(mesh.kept) == 0:
        raise InputError(
            f"{what} holds no triangles with three different corners.",
            "Check the units and the precision of the export.",
        )
    kept_paint = None if paint is None else Paint(paint.styles, paint.labels[mesh.kept])
    with np.errstate(over="ignore", invalid="ignore"):
        in_mm = mesh.vertices @ linear.T
    if not np.isfinite(in_mm).all():
        raise InputError(f"{what} has coordinates that are too large.", "Check the unit (--units).")
    return RawMesh(in_mm, mesh.faces, name, from_file, up_hint, paint=kept_paint)
