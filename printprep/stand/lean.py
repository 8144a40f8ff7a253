"""A lean as a user names it: 10, or 15@90 for a lean of 15° toward the azimuth of 90°."""

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
    """The lean that was asked for, the default where none was.

    Raises UsageError for what is no number, and for angles outside 0° to 60°.
    """
    if isinstance(asked, Lean):
        lean = asked
    else:
        angle, at, azimuth = str(default_deg if asked is None else asked).partition("@")
        try:
            lean = Lean(float(angle), float(azimuth) % 360.0 if at else None)
        except ValueError:
            raise UsageError(f"A lean of {asked!r} is not understood.", _FORM) from None
    if not 0 <= lean.angle_deg <= MOST_DEG:
        raise UsageError(f"A lean of {lean.angle_deg:g}° is not between 0° and {MOST_DEG:g}°.")
    if lean.azimuth_deg is not None and not 0 <= lean.azimuth_deg < 360:
        raise UsageError(f"An azimuth of {lean.azimuth_deg:g}° is not between 0° and 360°.")
    return lean


def tilt_toward(standing: Stability, lean: Lean) -> float | None:
    """The tilt angle that the lean is compared with: least of all, or toward its azimuth."""
    if lean.azimuth_deg is None:
        return standing.tilt_deg
    return directional_tilt_deg(standing, lean.azimuth_deg)
