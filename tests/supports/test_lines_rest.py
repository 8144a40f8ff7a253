"""Vaults for the printer, in G-code: every line rests on the ones below by the share promised."""

from __future__ import annotations

import numpy as np
import pytest
from gcode_rest import STEP_MM, Lines, layers_of, standing_out

from printprep import hollow
from printprep.mesh.measure import arrays, winding
from printprep.overhang.limits import printer_acceptance
from printprep.slicer.process import find_slicer
from printprep.slicer.prusa_ini import profile_settings

# Slicers thin out their outlines by about as much, and round G-code to 0.001 mm.
OUTLINE_MM = 0.0125
CORNER_MM = 0.2  # of all lines of a part


def lines(z: float, x0: float, x1: float, y: float) -> Lines:
    return Lines(z, np.array([[x0, y]]), np.array([[x1, y]]), np.array([0.45]))


@pytest.mark.parametrize(("beside_mm", "out_mm"), [(0.0, 0.0), (0.2, 0.2), (0.3, 0.3), (2.0, 2.0)])
def test_a_line_stands_out_by_the_distance_of_its_side(beside_mm, out_mm):
    _, out = standing_out([lines(0.2, 0, 10, 0), lines(0.4, 0, 10, beside_mm)])
    assert out.max() == pytest.approx(out_mm, abs=1e-9)
    assert out.min() == pytest.approx(max(out_mm - 0.45, 0.0), abs=1e-9)


@pytest.mark.slicer
@pytest.mark.slow
@pytest.mark.usefixtures("prusa_slicer")
@pytest.mark.parametrize("name", ["spot.stl", "bottle.stl", "goathead.stl"])
def test_every_line_over_a_cavity_rests_on_the_ones_below(name, samples_dir, tmp_path):
    made = hollow(samples_dir / name, size_mm=45.0)
    assert made.blocker is not None and made.supports is not None
    part, gcode = tmp_path / "part.3mf", tmp_path / "part.gcode"
    made.write(part)
    find_slicer().slice(part, gcode, profile_settings(made.profile))
    places, out = standing_out(layers_of(gcode))
    x, y, _ = made.profile.printer.bed_mm
    promised_mm = printer_acceptance(made.profile).off_mm
    far = out > 0.5 * promised_mm
    middles = places[far] - [x / 2, y / 2, made.profile.printer.layer_height_mm / 2]
    # The blocker holds all that lies over a cavity, and nothing that overhangs outside.
    over = winding(middles, *arrays(made.blocker)) > 0.5
    assert over.any()
    reached = out[far][over]
    assert (reached > promised_mm).mean() < 1e-3
    # At a corner the slicer turns a line early or late: there a sample or two may reach farther.
    farther = reached > promised_mm + 2 * OUTLINE_MM
    assert farther.sum() * STEP_MM <= CORNER_MM
    assert reached.max() < made.profile.printer.line_width_mm
