"""Cura's engine slices what we write as STL: hollow, as heavy and as steady as computed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from cura_engine import as_set_by_hand, slice_with_cura
from verify_parts import hollow_block

from printprep import hollow
from printprep.cli.run import run
from printprep.gcode.measure import measure_gcode
from printprep.gcode.printed import Printed
from printprep.result import HollowResult

pytestmark = pytest.mark.slicer


def printed_by_cura(engine: Path, result: HollowResult, folder: Path, **changes: str) -> Printed:
    """The print, measured with the part's cavities where Cura's engine puts the part."""
    model, gcode = folder / "part.stl", folder / "part.gcode"
    result.write(model, "cura")
    slice_with_cura(engine, model, gcode, as_set_by_hand(result.profile) | changes)
    x, y, _ = result.profile.printer.bed_mm
    cavities = [cavity.translate((x / 2, y / 2, 0)) for cavity in result.part.cavities]
    assert cavities
    return measure_gcode(
        gcode,
        cavities=cavities,
        diameter_mm=1.75,
        density_g_cm3=result.profile.material.density_g_cm3,
    )


@pytest.mark.parametrize("union", ["true", "false"])
def test_a_block_prints_hollow(cura_engine: Path, tmp_path: Path, union: str):
    result = hollow_block()
    printed = printed_by_cura(cura_engine, result, tmp_path, meshfix_union_all=union)
    assert printed.slicer_summary.producer == "Cura_SteamEngine 4.13.0"
    assert printed.mass_g == pytest.approx(result.mass_g, rel=0.04)
    assert printed.in_cavities_mm3 == 0.0
    x, y, _ = result.profile.printer.bed_mm
    centre = np.array(printed.centre_of_mass_mm) - [x / 2, y / 2, 0]
    np.testing.assert_allclose(centre, result.stability.centre_of_mass_mm, atol=0.5)
    assert printed.tilt_deg >= result.stability.tilt_deg - 1.0
    assert set(printed.feature_mass_g) == {"external perimeter", "perimeter", "solid infill"}


def test_a_sample_prints_hollow_and_stands(cura_engine: Path, samples_dir: Path, tmp_path: Path):
    result = hollow(samples_dir / "spot.stl", size_mm=60, resolution=48, vaults="none")
    printed = printed_by_cura(cura_engine, result, tmp_path)
    assert printed.mass_g == pytest.approx(result.mass_g, rel=0.04)
    assert printed.in_cavities_mm3 == 0.0
    assert printed.tilt_deg >= result.lean_deg - 1.0


def test_supports_stay_out_as_told_and_go_in_where_not(cura_engine: Path, tmp_path: Path):
    """``Support Placement: Touching Buildplate`` is on the list for a reason."""
    on = {"support_enable": "true"}
    result = hollow_block()
    printed = printed_by_cura(cura_engine, result, tmp_path, **on)
    assert printed.support_in_cavities_mm3 == 0.0
    printed = printed_by_cura(cura_engine, result, tmp_path, **on, support_type="everywhere")
    assert printed.support_in_cavities_mm3 > 100


def test_the_command_says_what_to_set(tmp_path: Path, samples_dir: Path, capsys):
    out = tmp_path / "bottle.stl"
    command = ["hollow", str(samples_dir / "bottle.stl"), "-o", str(out), "--size", "40"]
    command += ["--resolution", "24", "--no-self-support", "--for", "cura"]
    assert run(command) == 0
    said = " ".join(capsys.readouterr().out.split())
    for words in ("Infill Density 100 %", "Touching Buildplate", "Layer Height 0.2 mm"):
        assert words in said
    assert run([*command, "-p", "sls-pa12"]) == 2
