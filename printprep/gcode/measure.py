"""Measures what a G-code prints, in one pass over pieces of the file, however large it is."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import InputError
from printprep.files import reason_of
from printprep.gcode.features import LEFT_OUT

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.gcode.printed import Printed

_PIECE_BYTES = 4 << 20
_LINE_BYTES_MAX = 16 << 20


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
    cavities : solids that should stay empty, in the coordinates of the G-code.
    bodies : solids that do not touch, in the same coordinates; each is balanced by itself.
    left_out : features (:mod:`printprep.gcode.features`) that do not belong to the model.
    diameter_mm, density_g_cm3 : of the filament, in place of the figures in the file.

    Raises
    ------
    InputError : the file is missing, binary, malformed, or prints nothing.
    """
    from printprep.gcode.accumulate import Accumulator
    from printprep.gcode.modal_state import StateTracker

    path = Path(path)
    tracker = StateTracker()
    accumulator = Accumulator(tracker, path.name, cavities, bodies)
    for piece in _pieces(path):
        accumulator.add(piece)
    return accumulator.result(left_out, diameter_mm, density_g_cm3)


def _pieces(path: Path) -> Iterator[bytes]:
    """The content of a file in pieces that end with the end of a line."""
    try:
        with path.open("rb") as file:
            rest = b""
            while more := file.read(_PIECE_BYTES):
                if not rest:
                    _refuse_other_formats(path, more)
                whole, newline, rest_of = (rest + more).rpartition(b"\n")
                rest = rest_of
                if len(rest) > _LINE_BYTES_MAX:
                    raise InputError(
                        f"{path.name} is not G-code: it has a line of more than "
                        f"{_LINE_BYTES_MAX >> 20} MiB."
                    )
                if newline:
                    yield whole + newline
            if rest:
                yield rest + b"\n"
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist.", "Check the name and the folder.") from error
    except OSError as error:
        raise InputError(f"{path.name} cannot be read: {reason_of(error)}.") from error


def _refuse_other_formats(path: Path, head: bytes) -> None:
    if head.startswith(b"GCDE"):
        raise InputError(
            f"{path.name} is binary G-code.",
            "Switch off Binary G-code in the slicer's printer settings (binary_gcode = 0), "
            "or open the file in the slicer's G-code viewer and export it as text.",
        )
    if head.startswith(b"PK\x03\x04"):
        raise InputError(
            f"{path.name} is an archive, not G-code.",
            "Unpack the .gcode in it (Metadata/plate_1).",
        )
