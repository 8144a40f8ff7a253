"""What the real slicer prints as support inside a cavity: slice with supports on, read the G-code.

Not printprep's own opinion: PrusaSlicer decides where, this only adds up.
"""

from __future__ import annotations

import math
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from gcode_moves import extruding_moves
from manifold3d import Manifold
from numpy.typing import NDArray

from printprep.mesh.measure import arrays, winding
from printprep.mesh.quantize import quantized
from printprep.output.item import solid_item
from printprep.output.prusa_keys import blocker_keys
from printprep.profiles import Profile
from printprep.slicer.process import Slicer, find_slicer
from printprep.slicer.prusa_ini import FILAMENT_DIAMETER_MM, profile_settings
from printprep.threemf.write import write_3mf

Float = NDArray[np.float64]


def support_inside_g(
    outside: Manifold, cavity: Manifold, profile: Profile, threshold_deg: float
) -> float:
    """Grams of support material that PrusaSlicer puts into a cavity.

    threshold_deg : support_material_threshold; 0 is the automatic one.
    """
    return supports_g(find_slicer(), outside - cavity, cavity, profile, threshold_deg)[0]


def supports_g(
    slicer: Slicer,
    part: Manifold,
    cavity: Manifold,
    profile: Profile,
    threshold_deg: float,
    *,
    style: str = "grid",
    blocker: Manifold | None = None,
) -> tuple[float, float]:
    """Grams of support material inside a cavity of a part, and everywhere else.

    threshold_deg : support_material_threshold; 0 is the automatic one.
    style : support_material_style;  blocker : a support blocker in the file.
    """
    settings = {
        **profile_settings(profile),
        # Hollow, without solid layers: quicker, and supports do not depend on it (a cow's cavity at
        # a first layer of 0.25 mm takes 0.4580 g of them with either)
        "perimeters": "1",
        "perimeter_generator": "classic",
        "fill_density": "0%",
        "top_solid_layers": "0",
        "bottom_solid_layers": "0",
        "overhangs": "0",  # twice as quick; bridges then get support too, so nothing is missed
        "support_material": "1",
        "support_material_auto": "1",
        "support_material_threshold": f"{threshold_deg:g}",
        "support_material_style": style,
        "support_material_buildplate_only": "0",
        **({} if blocker is None else blocker_keys(profile)),
    }
    item = solid_item(quantized(part), "part", profile, blocker=blocker)
    with tempfile.TemporaryDirectory() as folder:
        model, gcode = Path(folder) / "part.3mf", Path(folder) / "part.gcode"
        # Settings of an object would override these.
        model.write_bytes(write_3mf([replace(item, settings={})]))
        slicer.slice(model, gcode, settings)
        middles, filament_mm = support_moves(gcode)
    x, y, z = item.translation_mm
    middles = middles - [x, y, z + profile.printer.layer_height_mm / 2]
    inside = winding(middles, *arrays(cavity)) > 0.5
    area = math.pi / 4 * FILAMENT_DIAMETER_MM**2
    grams = filament_mm * area * profile.material.density_g_cm3 / 1000
    return float(grams[inside].sum()), float(grams[~inside].sum())


def support_moves(gcode: Path) -> tuple[Float, Float]:
    """(n, 3) middles of the extruding moves of support, and (n,) filament each takes, mm."""
    moves = [m for m in extruding_moves(gcode) if m.kind.startswith("Support material")]
    middles = [(*np.add(move.start, move.end) / 2, move.z_mm) for move in moves]
    filament = [move.filament_mm for move in moves]
    return np.array(middles).reshape(-1, 3), np.array(filament)
