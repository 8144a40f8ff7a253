"""How much filament a unit of E is, and what it weighs, as the file says or is told."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

from printprep.gcode.modal_state import Listener, numbers

DIAMETER_MM = 1.75
DENSITY_G_CM3 = 1.24


class Key(NamedTuple):
    """What is added up apart: body is an index into those given, 0 without any."""

    feature: str
    tool: int
    volumetric: bool
    body: int = 0


class Filament:
    """What a unit of filament is, in mm³ and grams, by extruder."""

    def __init__(
        self, listener: Listener, diameter_mm: float | None, density_g_cm3: float | None
    ) -> None:
        settings = listener.settings
        self._volumetric = settings.get("use_volumetric_e") == "1"
        assumed = []
        self._diameters = (diameter_mm,) if diameter_mm else numbers(settings, "filament_diameter")
        if not any(self._diameters):
            self._diameters = (DIAMETER_MM,)
            assumed.append(f"Filament of {DIAMETER_MM:g} mm is assumed; the file does not say.")
        self._densities = (
            (density_g_cm3,) if density_g_cm3 else numbers(settings, "filament_density")
        )
        if not any(self._densities):
            self._densities = (DENSITY_G_CM3,)
            assumed.append(
                f"Filament of {DENSITY_G_CM3:g} g/cm³ is assumed; the file does not say."
            )
        self.assumed = tuple(assumed)

    def mm3(self, key: Key) -> float:
        """Of one unit of E."""
        if key.volumetric or self._volumetric:
            return 1.0
        return math.pi / 4 * _of(self._diameters, key.tool) ** 2

    def g_cm3(self, key: Key) -> float:
        return _of(self._densities, key.tool)


def _of(values: Sequence[float], tool: int) -> float:
    """An extruder's value; where it has none, or 0, the first that is one."""
    if tool < len(values) and values[tool] > 0:
        return values[tool]
    return next(value for value in values if value > 0)
