"""Writes a profile as an .ini of PrusaSlicer: the print settings that no 3MF can carry.

It holds only what the profile fixes and what follows from that; speeds, temperatures and start
G-code belong to the printer, and stay as they are set in the slicer.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.slicer.sanitize import settings_ini

if TYPE_CHECKING:
    from printprep.profiles import Profile

FILAMENT_DIAMETER_MM = 1.75


def profile_settings(profile: Profile) -> dict[str, str]:
    """The profile's print, filament and printer settings, by PrusaSlicer's keys.

    Raises UsageError for a profile that is not fdm.
    """
    printer = profile.printer
    if printer.nozzle_mm is None or printer.line_width_mm is None:
        raise UsageError(
            f"PrusaSlicer's .ini is for filament; profile {profile.name} is for {profile.process}.",
            "Choose a profile for filament: `printprep profiles` lists them.",
        )
    width = f"{printer.line_width_mm:g}"
    x, y, z = (f"{length:g}" for length in printer.bed_mm)
    return {
        "printer_technology": "FFF",
        "nozzle_diameter": f"{printer.nozzle_mm:g}",
        "bed_shape": f"0x0,{x}x0,{x}x{y},0x{y}",
        "max_print_height": z,
        "layer_height": f"{printer.layer_height_mm:g}",
        "first_layer_height": f"{printer.first_layer_mm:g}",
        "max_layer_height": f"{max(printer.layer_height_mm, 0.8 * printer.nozzle_mm):g}",
        "extrusion_width": width,
        "external_perimeter_extrusion_width": width,
        "first_layer_extrusion_width": width,
        "infill_extrusion_width": width,
        "perimeter_extrusion_width": width,
        "solid_infill_extrusion_width": width,
        "top_infill_extrusion_width": width,
        "perimeters": "2",
        "top_solid_layers": "5",
        "bottom_solid_layers": "4",
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "support_material": "0",
        "support_material_buildplate_only": "1",
        "raft_layers": "0",
        "spiral_vase": "0",
        # Closing holes would fill a cavity; squeezing the first layer would shrink the contact
        "slicing_mode": "regular",
        "elefant_foot_compensation": "0",
        "filament_type": profile.material.name,
        "filament_density": f"{profile.material.density_g_cm3:g}",
        "filament_diameter": f"{FILAMENT_DIAMETER_MM:g}",
        "extrusion_multiplier": "1",
        **profile.object_settings,
    }


def profile_ini(profile: Profile) -> str:
    """The profile as .ini text for PrusaSlicer's --load or Import Config."""
    return f"# printprep profile {profile.name}\n{settings_ini(profile_settings(profile))}"
