"""Places a mesh on the printer's bed: z is up, sizes are mm, the bed is z = 0."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError, UsageError
from printprep.types import Model

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.mesh.read import RawMesh


# Larger than any printer, and smaller than anything that one can print: such numbers are a wrong
# unit, and no stage can work on them.
_LARGEST_MM = 5000.0
_SMALLEST_MM = 1e-3

# Proper rotations (determinant +1) by quarter turns that take the named file axis to +z: about x
# for ±y, about y for ±x, half a turn about x for −z, the shortest turn in each case.
_TURNS: dict[str, tuple[tuple[int, int, int], ...]] = {
    "+x": ((0, 0, -1), (0, 1, 0), (1, 0, 0)),
    "-x": ((0, 0, 1), (0, 1, 0), (-1, 0, 0)),
    "+y": ((1, 0, 0), (0, 0, -1), (0, 1, 0)),
    "-y": ((1, 0, 0), (0, 0, 1), (0, -1, 0)),
    "+z": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    "-z": ((1, 0, 0), (0, -1, 0), (0, 0, -1)),
}


def rotation(up: str) -> Float:
    """(3, 3) proper rotation that takes the file axis ``up`` (x, y, z with optional sign) to +z.

    Raises UsageError for anything else.
    """
    axis = up.strip().lower()
    turn = _TURNS.get(axis if axis[:1] in ("+", "-") else f"+{axis}")
    if turn is None:
        raise UsageError(
            f"--up {up!r} is not an axis.", "Use x, y or z, with an optional sign: +z, -y."
        )
    return np.array(turn, dtype=np.float64)


def place(
    raw: RawMesh,
    *,
    up: str = "+z",
    scale: float | None = None,
    height_mm: float | None = None,
    size_mm: float | None = None,
) -> Model:
    """Turn, scale and move a mesh: bounding box centred on x = y = 0, lowest point at z = 0.

    up : the axis of the mesh that points up on the bed.  At most one of ``scale`` (a factor),
    ``height_mm`` (extent along z after turning) and ``size_mm`` (longest side of the bounding box).

    Raises
    ------
    UsageError : two of these at once, one that is not a positive number, an unknown axis, or a
        height for a mesh that is flat.
    GeometryError : the placed model is larger or smaller than anything that is printed.
    """
    turn = rotation(up)
    turned = raw.vertices @ turn.T
    extents = turned.max(axis=0) - turned.min(axis=0)
    factor = _factor(extents, scale, height_mm, size_mm)
    side_mm = float(extents.max()) * factor
    refuse_size(raw.name, side_mm if math.isfinite(factor) else float(extents.max()))
    scaled = turned * factor
    low, high = scaled.min(axis=0), scaled.max(axis=0)
    shift = -np.array([(low[0] + high[0]) / 2, (low[1] + high[1]) / 2, low[2]])
    step = np.eye(4)
    step[:3, :3] = factor * turn
    step[:3, 3] = shift
    return Model(
        vertices=np.ascontiguousarray(scaled + shift),
        faces=raw.faces,
        placement=step @ raw.from_file,
        name=raw.name,
        notes=raw.notes,
        paint=raw.paint,
        blockers=raw.blockers,
    )


def refuse_size(name: str, side_mm: float) -> None:
    """Raise GeometryError for a longest side that no printer prints."""
    if _SMALLEST_MM <= side_mm <= _LARGEST_MM:
        return
    small = side_mm < _SMALLEST_MM
    raise GeometryError(
        f"{name} is {_length(side_mm)} along its longest side: too {'small' if small else 'large'} "
        f"to print ({'less' if small else 'more'} than "
        f"{_SMALLEST_MM if small else _LARGEST_MM:g} mm).",
        "Name the unit of the file with --units, or the size in mm with --size or --scale.",
    )


def _length(side_mm: float) -> str:
    """A length in words, in metres where that is plainer ("100 m")."""
    return f"{side_mm / 1000:.4g} m" if 1e3 <= side_mm < 1e7 else f"{side_mm:.4g} mm"


def _factor(
    extents: Float, scale: float | None, height_mm: float | None, size_mm: float | None
) -> float:
    """The factor that one of the three arguments asks for; extents : (3,), after turning."""
    given = {
        name: value
        for name, value in (("--scale", scale), ("--height", height_mm), ("--size", size_mm))
        if value is not None
    }
    if len(given) > 1:
        raise UsageError(
            f"{' and '.join(given)} exclude each other.", "Give the size in one way only."
        )
    for name, value in given.items():
        if not (math.isfinite(value) and value > 0):
            raise UsageError(f"{name} {value:g} is not a positive number.")
    if scale is not None:
        return float(scale)
    target, extent, what = (
        (height_mm, float(extents[2]), "height")
        if height_mm is not None
        else (size_mm, float(extents.max()), "size")
    )
    if target is None:
        return 1.0
    if extent <= 0:
        raise UsageError(f"The model is flat: it has no {what} that could become {target:g} mm.")
    with np.errstate(over="ignore"):
        return float(np.float64(target) / np.float64(extent))
