"""Volume and mass of one unit of filament (E), from the file's settings or from the caller."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from printprep.errors import InputError
from printprep.gcode.modal_state import StateTracker, numbers

DIAMETER_MM = 1.75
DENSITY_G_CM3 = 1.24
_DIAMETERS_MM = (0.1, 50.0)
_DENSITIES = (0.01, 50.0)


class Key(NamedTuple):
    """One of the sums over a G-code; body : index among the bodies given, 0 without any."""

    feature: str
    tool: int
    volumetric: bool
    body: int = 0


class Filament:
    """Volume and density of filament, by extruder; ``assumed`` says what the file leaves open.

    diameter_mm, density_g_cm3 : in place of the figures in the file.
    """

    def __init__(
        self, tracker: StateTracker, diameter_mm: float | None, density_g_cm3: float | None
    ) -> None:
        settings = tracker.settings
        self._volumetric = settings.get("use_volumetric_e") == "1"
        assumed = []
        given = (diameter_mm,) if diameter_mm else numbers(settings, "filament_diameter")
        self._diameters = _sensible(given, _DIAMETERS_MM, "filament diameter", "mm", tracker.name)
        if not self._diameters:
            self._diameters = (DIAMETER_MM,)
            assumed.append(f"The file names no filament diameter: {DIAMETER_MM:g} mm is assumed.")
        given = (density_g_cm3,) if density_g_cm3 else numbers(settings, "filament_density")
        self._densities = _sensible(given, _DENSITIES, "filament density", "g/cm³", tracker.name)
        if not self._densities:
            self._densities = (DENSITY_G_CM3,)
            assumed.append(
                f"The file names no filament density: {DENSITY_G_CM3:g} g/cm³ is assumed."
            )
        self.assumed = tuple(assumed)

    def mm3(self, key: Key) -> float:
        """Volume of one unit of E."""
        if key.volumetric or self._volumetric:
            return 1.0
        return math.pi / 4 * _of(self._diameters, key.tool) ** 2

    def g_cm3(self, key: Key) -> float:
        """Density of the filament."""
        return _of(self._densities, key.tool)


def _sensible(
    values: Sequence[float], limits: tuple[float, float], what: str, unit: str, name: str
) -> tuple[float, ...]:
    """The values, one for each extruder; empty where all are 0, which slicers write for "unknown".

    name : of the file.  Raises InputError for a value outside ``limits``, in ``unit``.
    """
    low, high = limits
    for value in values:
        if value != 0 and not low <= value <= high:
            raise InputError(
                f"{name} gives a {what} of {value:g} {unit}; it must be from {low:g} to {high:g}.",
                "Correct it in the slicer's filament settings, and slice again.",
            )
    return tuple(values) if any(values) else ()


def _of(values: Sequence[float], tool: int) -> float:
    """The value of an extruder; where it has none, or 0, the first one above 0."""
    if tool < len(values) and values[tool] > 0:
        return values[tool]
    return next(value for value in values if value > 0)
