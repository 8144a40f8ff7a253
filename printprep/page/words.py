"""Numbers as a page says them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.profiles import Profile

FILAMENT_MM = 1.75  # the usual diameter, where a profile names none


def plain(value: float) -> str:
    """Three significant digits, without an exponent for what a printer can make."""
    return f"{value:.0f}" if value >= 1000 else f"{value:.3g}" if value < 100 else f"{value:.1f}"


def mass(mass_g: float) -> str:
    """For example "18.5 g"."""
    if mass_g >= 1000:
        return f"{plain(mass_g / 1000)} kg"
    return f"{plain(mass_g)} g" if mass_g >= 0.1 or mass_g == 0 else f"{plain(1000 * mass_g)} mg"


def tilt(tilt_deg: float | None) -> str:
    """For example "14.2°"."""
    return "no contact" if tilt_deg is None else f"{tilt_deg:.1f}°".replace("-", "−")


def hours(seconds: float | None) -> str:
    """For example "3 h 12 min"."""
    if seconds is None:
        return "unknown"
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60:02d} min" if minutes >= 60 else f"{minutes} min"


def material_used(mass_g: float, profile: Profile) -> tuple[str, str]:
    """Filament as a length, anything else as a volume; and what it is of."""
    volume_mm3 = 1000 * mass_g / profile.material.density_g_cm3
    if profile.traits.has_nozzle:
        diameter = profile.printer.filament_mm or FILAMENT_MM
        metres = volume_mm3 / (math.pi / 4 * diameter**2) / 1000
        return f"{plain(metres)} m", f"of {diameter:g} mm filament"
    return f"{plain(volume_mm3 / 1000)} ml", f"of {profile.material.name}"


def cost(mass_g: float, profile: Profile) -> str | None:
    """The price of the material, None where the profile names none."""
    price = profile.material.price_per_kg
    if price is None:
        return None
    currency = profile.material.currency
    amount = f"{price * mass_g / 1000:.2f}"
    return amount if currency is None else f"{amount} {currency}"
