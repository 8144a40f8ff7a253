"""Measure a G-code: one pass over the file, in pieces, so that its size does not matter."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import InputError
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
    """What a G-code prints: mass, balance, contact, and what lies where nothing should.

    Parameters
    ----------
    cavities : solids that should stay empty, in the G-code's coordinates.
    bodies : solids that do not touch, likewise, to be balanced each by itself.
    left_out : names of features (:mod:`printprep.gcode.features`) that are no part of the model.
    diameter_mm, density_g_cm3 : of the filament, where the file should not be asked.

    Raises
    ------
    InputError : the file is missing, binary, malformed, or prints nothing.
    """
    from printprep.gcode.accumulate import Accumulator
    from printprep.gcode.modal_state import Listener

    path = Path(path)
    listener = Listener()
    tally = Accumulator(listener, path.name, cavities, bodies)
    for piece in _pieces(path):
        tally.add(piece)
    return tally.result(left_out, diameter_mm, density_g_cm3)


def _pieces(path: Path) -> Iterator[bytes]:
    """The file in pieces that end with the end of a line."""
    try:
        with path.open("rb") as file:
            rest = b""
            while more := file.read(_PIECE_BYTES):
                if not rest:
                    _refuse_other_formats(path, more)
                whole, newline, rest_of = (rest + more).rpartition(b"\n")
                rest = rest_of
                if len(rest) > _LINE_BYTES_MAX:
                    raise InputError(f"{path.name}: has a line that no G-code has")
                if newline:
                    yield whole + newline
            if rest:
                yield rest + b"\n"
    except FileNotFoundError as error:
        raise InputError(f"{path}: there is no such file") from error
    except OSError as error:
        raise InputError(f"{path.name}: cannot be read ({error.strerror})") from error


def _refuse_other_formats(path: Path, head: bytes) -> None:
    if head.startswith(b"GCDE"):
        raise InputError(
            f"{path.name}: is binary G-code",
            "switch off Binary G-code in the slicer's printer settings (binary_gcode = 0), "
            "or open it in the slicer's G-code viewer and export it as text",
        )
    if head.startswith(b"PK\x03\x04"):
        raise InputError(
            f"{path.name}: is an archive, not G-code", "unpack the .gcode in it (Metadata/plate_1)"
        )
