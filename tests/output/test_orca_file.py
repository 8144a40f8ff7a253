"""A part for OrcaSlicer and BambuStudio: its file carries all that those keep of an object."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from closed_form_parts import box, hollow_result
from orca_judge import KEYS, read_as_orca

from printprep.errors import UsageError
from printprep.mesh.measure import try_manifold
from printprep.mesh.quantize import quantized
from printprep.mesh.weld import weld
from printprep.mesh.write import to_bytes
from printprep.output.item import infill_item
from printprep.output.limits import carries_blocker, check_infill_output, format_findings
from printprep.output.orca_keys import object_settings, orca_item, orca_setting
from printprep.output.part_file import part_bytes
from printprep.output.prusa_keys import layers, lines
from printprep.pipeline.job import Job, run_job
from printprep.pipeline.options import FillOptions
from printprep.profiles import load_profile
from printprep.threemf.read import read_3mf
from printprep.threemf.write import write_3mf

PLA = load_profile("fdm-pla-0.4")


def test_the_part_its_settings_and_its_blocker_travel(tmp_path: Path) -> None:
    blocker = box(16, 17.2, z=2)
    result = replace(hollow_result(), blocker=blocker)
    content = part_bytes(result.contents(), ".3mf", "orca")
    assert content == part_bytes(result.contents(), ".3mf", "orca")
    (found,) = read_as_orca(content)
    assert found.name == "block"
    assert found.settings == {
        "elefant_foot_compensation": "0",
        "slicing_mode": "regular",
        "sparse_infill_density": "100%",
        "sparse_infill_pattern": "monotonic",
        "support_on_build_plate_only": "1",
    }
    solid, stop = found.volumes
    assert (solid.subtype, stop.subtype) == ("normal_part", "support_blocker")
    part = try_manifold(*weld(solid.vertices, solid.faces))[0]
    assert part.volume() == pytest.approx(3904, rel=1e-6)
    stopped = try_manifold(*weld(stop.vertices, stop.faces))[0]
    assert (stopped - blocker.translate((125, 105, 0))).volume() == pytest.approx(0, abs=1e-3)
    assert stopped.volume() == pytest.approx(blocker.volume(), rel=1e-6)
    path = tmp_path / "part.3mf"
    result.write(path, "orca")
    back = read_3mf(path)
    assert np.isclose(try_manifold(*weld(back.vertices, back.faces))[0].volume(), 3904)
    assert len(back.blockers) == 1
    assert back.notes == ()


def test_the_ballast_of_an_infill_print_is_a_dense_modifier() -> None:
    part, ballast = quantized(box(10, 20)), box(8, 5, z=1)
    item = orca_item(infill_item(part, [ballast], "leaning", PLA))
    (found,) = read_as_orca(write_3mf([item], dialect="orca"))
    assert found.settings == {
        "elefant_foot_compensation": "0",
        "slicing_mode": "regular",
        "sparse_infill_density": "15%",
        "sparse_infill_pattern": "lightning",
        "wall_loops": str(lines(PLA)),
        "top_shell_layers": str(layers(PLA)),
        "bottom_shell_layers": str(layers(PLA)),
    }
    solid, dense = found.volumes
    assert (solid.subtype, solid.settings) == ("normal_part", {})
    assert (dense.name, dense.subtype) == ("ballast", "modifier_part")
    assert dense.settings == {
        "sparse_infill_density": "100%",
        "sparse_infill_pattern": "monotonic",
    }


def test_every_setting_of_a_filament_profile_travels() -> None:
    for name in ("fdm-pla-0.4", "fdm-pla-0.6", "fdm-petg-0.4"):
        for wall_mm in (1.2, 2.4):
            profile = load_profile(name, {"wall_mm": wall_mm})
            for key, value in profile.object_settings.items():
                translated = orca_setting(key, value)
                assert translated is not None
                assert KEYS[translated[0]](translated[1])


@pytest.mark.parametrize(
    ("key", "value", "translated"),
    [
        ("perimeters", "3", ("wall_loops", "3")),
        ("fill_pattern", "rectilinear", ("sparse_infill_pattern", "monotonic")),
        ("fill_pattern", "stars", ("sparse_infill_pattern", "tri-hexagon")),
        ("fill_pattern", "gyroid", ("sparse_infill_pattern", "gyroid")),
        ("fill_pattern", "zigzag", None),
        ("fill_angle", "45", None),
        ("slicing_mode", "even_odd", ("slicing_mode", "even_odd")),
    ],
)
def test_a_setting_is_translated_or_left(
    key: str, value: str, translated: tuple[str, str] | None
) -> None:
    assert orca_setting(key, value) == translated


def test_a_profiles_own_setting_stands_over_the_usual_one() -> None:
    assert object_settings({"elefant_foot_compensation": "0.1"}) == {
        "elefant_foot_compensation": "0.1",
        "slicing_mode": "regular",
    }


def test_only_what_does_not_travel_is_listed() -> None:
    profile = load_profile(
        "fdm-pla-0.4", {"wall_mm": 2.4, "slicer.object_settings.fill_angle": "30"}
    )
    (said,) = format_findings(profile, Path("part.3mf"), "orca")
    assert (said.rule, said.severity) == ("set-by-hand", "info")
    for text in (
        "Layer height 0.2 mm",
        "layer height 0.2 mm",
        "Line width 0.45 mm",
        "fill_angle=30",
    ):
        assert text in said.message
    for text in ("Wall loops", "Sparse", "100 %", "build plate", "Elephant", "Slicing mode"):
        assert text not in said.message
    # BambuStudio drops the settings of an object from another program.
    assert said.fix is not None
    for text in ("Wall loops 3", "density 100 %", "pattern Monotonic", "plate only on", "foot"):
        assert text in said.fix
    (said,) = format_findings(PLA, Path("part.3mf"), "orca", infill=True)
    assert said.fix is not None
    assert "density 15 %; Sparse infill pattern Lightning" in said.fix
    assert "for the ballast: Sparse infill density 100 %" in said.fix


def test_what_a_file_for_each_slicer_carries() -> None:
    assert carries_blocker(".3MF", "orca")
    for suffix, slicer in ((".stl", "orca"), (".3mf", "cura"), (".3mf", "generic")):
        assert not carries_blocker(suffix, slicer)  # type: ignore[arg-type]
        with pytest.raises(UsageError):
            check_infill_output(suffix, slicer)  # type: ignore[arg-type]
    check_infill_output(".3mf", "orca")


def test_vaults_are_built_for_the_printer_as_for_prusaslicer(tmp_path: Path) -> None:
    model = tmp_path / "block.stl"
    model.write_bytes(to_bytes(box(16, 12), ".stl"))
    options = FillOptions(resolution=16, base="never")
    for_orca = run_job(Job(model, tmp_path / "orca.3mf", options=options, written_for="orca"))
    assert for_orca.result.supports is not None
    assert for_orca.result.supports.rule == "printer"
    assert {one.rule for one in for_orca.findings} >= {"set-by-hand"}
    assert not {one.rule for one in for_orca.findings} & {"vaults-for-slicer", "no-blocker"}
    for_orca.result.write(tmp_path / "prusa.3mf")
    ours, same = read_3mf(tmp_path / "orca.3mf"), read_3mf(tmp_path / "prusa.3mf")
    assert ours.vertices.tolist() == same.vertices.tolist()
    (blocker,), (other,) = ours.blockers, same.blockers
    assert blocker.vertices.tolist() == other.vertices.tolist()
    (found,) = read_as_orca((tmp_path / "orca.3mf").read_bytes())
    assert [one.subtype for one in found.volumes] == ["normal_part", "support_blocker"]


def test_a_file_for_cura_has_vaults_by_the_slicers_rule(tmp_path: Path) -> None:
    model = tmp_path / "block.stl"
    model.write_bytes(to_bytes(box(16, 12), ".stl"))
    options = FillOptions(resolution=16, base="never")
    done = run_job(Job(model, tmp_path / "cura.3mf", options=options, written_for="cura"))
    assert done.result.supports is not None
    assert done.result.supports.rule == "slicer"
    assert "vaults-for-slicer" in {one.rule for one in done.findings}
