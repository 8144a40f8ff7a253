"""Reads a lean as the user writes it: 10, or 15@90 for 15° toward the azimuth of 90°."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.stand.directional import directional_tilt_deg
from printprep.types import Lean

if TYPE_CHECKING:
    from printprep.types import Stability

MOST_DEG = 60.0
_FORM = "Give degrees, as 10, or degrees@azimuth, as 15@90 (azimuth from +x, counter-clockwise)."


def lean_of(asked: float | str | Lean | None, default_deg: float) -> Lean:
    """The lean that the user asks for, the default where there is none.

    Raises UsageError for text that is not a lean, and for angles outside 0° to 60°.
    """
    if isinstance(asked, Lean):
        lean = asked
    else:
        angle, at, azimuth = str(default_deg if asked is None else asked).partition("@")
        try:
            lean = Lean(float(angle), float(azimuth) % 360.0 if at else None)
        except ValueError:
            raise UsageError(f"{asked!r} is not a lean.", _FORM) from None
    if not 0 <= lean.angle_deg <= MOST_DEG:
        raise UsageError(f"A lean of {lean.angle_deg:g}° is not between 0° and {MOST_DEG:g}°.")
    if lean.azimuth_deg is not None and not 0 <= lean.azimuth_deg < 360:
        raise UsageError(f"An azimuth of {lean.azimuth_deg:g}° is not between 0° and 360°.")
    return lean


def tilt_toward(standing: Stability, lean: Lean) -> float | None:
    """The tilt angle to compare with the lean: the least one, or the one toward its azimuth."""
    if lean.azimuth_deg is None:
        return standing.tilt_deg
    return directional_tilt_deg(standing, lean.azimuth_deg)
