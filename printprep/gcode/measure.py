"""Measures what a G-code prints, in one pass over pieces of the file, however large it is."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import InputError, ToolError
from printprep.gcode.features import LEFT_OUT

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.gcode.printed import Printed

_WHOLE_SHARE = 0.9  # the moves of a whole file add up to the count within 0.5 %
_ROUNDING_MM3 = 10.0


def measure_gcode(
    path: str | Path,
    *,
    cavities: Sequence[Manifold] = (),
    bodies: Sequence[Manifold] = (),
    left_out: Collection[str] = LEFT_OUT,
    diameter_mm: float | None = None,
    density_g_cm3: float | None = None,
) -> Printed:
    """Mass, balance and contact of what a G-code prints, and what it prints inside cavities.

    Parameters
    ----------
    path : G-code as text, binary G-code (.bgcode), or a sliced project (.gcode.3mf); the content
        decides, not the name.
    cavities : solids that should stay empty, in the coordinates of the G-code.
    bodies : solids that do not touch, in the same coordinates; each is balanced by itself.
    left_out : features (:mod:`printprep.gcode.features`) that do not belong to the model.
    diameter_mm, density_g_cm3 : of the filament, in place of the figures in the file.

    Raises
    ------
    InputError : the file is missing, malformed, cut off, beyond a limit, or prints nothing.
    """
    from printprep.gcode.accumulate import Accumulator
    from printprep.gcode.modal_state import StateTracker
    from printprep.gcode.source import is_binary_file, pieces

    path = Path(path)
    tracker = StateTracker(path.name)
    accumulator = Accumulator(tracker, path.name, cavities, bodies)
    for piece in pieces(path):
        accumulator.add(piece)
    printed = accumulator.result(left_out, diameter_mm, density_g_cm3)
    if is_binary_file(path):
        _refuse_half(path, printed)
    return printed


def measure_sliced(
    path: Path,
    slicer: str,
    *,
    cavities: Sequence[Manifold] = (),
    bodies: Sequence[Manifold] = (),
) -> Printed:
    """As ``measure_gcode``, for a file that a slicer just wrote; slicer : its name.

    Raises ToolError where it is no G-code that can be measured.
    """
    try:
        return measure_gcode(path, cavities=cavities, bodies=bodies)
    except InputError as error:
        raise ToolError(
            f"{slicer} wrote G-code that cannot be measured: {error.message}",
            "Slice the file by hand once, to see what it prints.",
        ) from error


def _refuse_half(path: Path, printed: Printed) -> None:
    """Raise InputError for binary G-code that prints far less than the count at its head."""
    counted = printed.slicer_summary.filament_mm3
    if counted and printed.filament_mm3 < _WHOLE_SHARE * counted - _ROUNDING_MM3:
        raise InputError(
            f"{path.name} is cut off: its moves take {printed.filament_mm3 / 1000:.2f} cm³ of the "
            f"{counted / 1000:.2f} cm³ that it names.",
            "Export it again from the slicer.",
        )
