"""What is written is what was checked, whole or not at all, and its cavity stays hollow."""

from __future__ import annotations

import io
import json
import os
import stat
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from closed_form_parts import hollow_result
from judges import read_strictly

from printprep.errors import OutputError, UsageError
from printprep.mesh.quantize import quantized_arrays
from printprep.output.limits import check_output, format_findings
from printprep.output.manual_settings import check_slicer
from printprep.output.part_file import part_bytes, write_part
from printprep.profiles import load_profile

SUFFIXES = (".3mf", ".stl", ".obj", ".ply")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_volume_and_orientation_survive_the_file(tmp_path: Path, suffix: str):
    path = tmp_path / f"part{suffix}"
    hollow_result(with_base=True).write(path)
    mesh = trimesh.load_mesh(path, process=False)
    mesh.merge_vertices()
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(3904 + 176, rel=1e-6)  # the cavity counts as a hole
    assert not list(tmp_path.glob("*.part"))


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_the_same_result_gives_the_same_bytes(suffix: str):
    assert part_bytes(hollow_result().contents(), suffix) == part_bytes(
        hollow_result(seconds={"read": 9.0}).contents(), suffix
    )


def test_the_3mf_holds_the_checked_triangles_settings_and_proof():
    result = hollow_result()
    archive = zipfile.ZipFile(io.BytesIO(part_bytes(result.contents(), ".3mf")))
    config = archive.read("Metadata/Slic3r_PE_model.config").decode()
    for key, value in result.profile.slicer.object_settings.items():
        assert f'key="{key}" value="{value}"' in config
    _, faces = quantized_arrays(result.part.manifold)
    assert f'<volume firstid="0" lastid="{len(faces) - 1}">' in config
    assert config.count("<volume ") == 1
    embedded = json.loads(archive.read("Metadata/printprep.json"))
    assert embedded["mass_g"] == 4.84096
    assert archive.read("Metadata/thumbnail.png").startswith(b"\x89PNG")
    model = archive.read("3D/3dmodel.model").decode()
    assert 'transform="1 0 0 0 1 0 0 0 1 125 105 0"' in model  # the middle of the MK3's bed
    assert model.count("<vertex ") == 16


def test_nothing_of_user_or_machine_is_in_the_3mf(tmp_path: Path):
    archive = zipfile.ZipFile(io.BytesIO(part_bytes(hollow_result().contents(), ".3mf")))
    everything = b"".join(archive.read(name) for name in archive.namelist())
    for secret in (str(tmp_path), str(Path.home()), os.environ.get("USER", "nobody-at-all")):
        if len(secret) > 3:
            assert secret.encode() not in everything


@pytest.mark.slicer
def test_the_slicer_takes_it_as_one_manifold_with_its_cavity(tmp_path: Path, prusa_slicer: Path):
    path = tmp_path / "part.3mf"
    hollow_result().write(path)
    done = subprocess.run(
        [prusa_slicer, "--info", path],
        capture_output=True,
        encoding="utf-8",
        check=True,
        timeout=120,
    )
    facts = dict(line.split(" = ") for line in done.stdout.splitlines() if " = " in line)
    assert facts["manifold"] == "yes"
    assert float(facts["volume"]) == pytest.approx(3904, rel=1e-5)


def test_lib3mf_reads_it_strictly_without_a_warning(tmp_path: Path):
    lib3mf = pytest.importorskip("lib3mf")
    path = tmp_path / "part.3mf"
    hollow_result().write(path)
    model = lib3mf.get_wrapper().CreateModel()
    reader = model.QueryReader("3mf")
    reader.SetStrictModeActive(True)
    reader.ReadFromFile(str(path))
    assert reader.GetWarningCount() == 0
    meshes = model.GetMeshObjects()
    assert meshes.MoveNext()
    assert meshes.GetCurrentMeshObject().IsManifoldAndOriented()


class TestOutput:
    def test_unknown_suffix_is_usage(self, tmp_path: Path):
        with pytest.raises(UsageError, match=r"\.step is not a format") as caught:
            check_output(tmp_path / "part.step")
        assert ".3mf" in caught.value.hint
        with pytest.raises(UsageError, match="without a suffix"):
            check_output(tmp_path / "part")

    def test_missing_folder(self, tmp_path: Path):
        with pytest.raises(OutputError, match="does not exist"):
            check_output(tmp_path / "nowhere" / "part.3mf")

    def test_a_folder_in_its_place(self, tmp_path: Path):
        (tmp_path / "part.3mf").mkdir()
        with pytest.raises(OutputError, match="is a folder"):
            check_output(tmp_path / "part.3mf")

    @pytest.mark.skipif(
        sys.platform == "win32" or os.geteuid() == 0, reason="permissions do not bind here"
    )
    def test_a_folder_that_refuses(self, tmp_path: Path):
        tmp_path.chmod(stat.S_IRUSR | stat.S_IXUSR)
        with pytest.raises(OutputError, match="may not be written to"):
            check_output(tmp_path / "part.3mf")

    def test_suffixes_in_capitals_are_taken(self, tmp_path: Path):
        write_part(hollow_result().contents(), tmp_path / "PART.STL")
        assert (tmp_path / "PART.STL").stat().st_size == 84 + 24 * 50

    def test_an_existing_file_is_replaced(self, tmp_path: Path):
        path = tmp_path / "part.stl"
        path.write_text("old")
        write_part(hollow_result().contents(), str(path))
        assert path.read_bytes() == part_bytes(hollow_result().contents(), ".stl")


@pytest.mark.parametrize("slicer", ["cura", "generic"])
def test_for_another_slicer_the_shape_is_alone_and_the_rest_is_said(slicer: str, tmp_path: Path):
    result = hollow_result()
    prusa = zipfile.ZipFile(io.BytesIO(part_bytes(result.contents(), ".3mf")))
    plain = zipfile.ZipFile(io.BytesIO(part_bytes(result.contents(), ".3mf", slicer)))
    config = "Metadata/Slic3r_PE_model.config"
    assert set(prusa.namelist()) - set(plain.namelist()) == {config}
    for name in set(plain.namelist()) - {"[Content_Types].xml"}:
        assert plain.read(name) == prusa.read(name)
    result.write(tmp_path / "part.3mf", slicer)
    mesh, warnings = read_strictly(tmp_path / "part.3mf")
    assert not warnings and len(mesh.vertices) == 16
    assert part_bytes(result.contents(), ".stl", slicer) == part_bytes(result.contents(), ".stl")
    for name in ("part.3mf", "part.stl"):
        (finding,) = format_findings(result.profile, Path(name), slicer)
        assert (finding.rule, finding.severity) == ("set-by-hand", "info")
        for value in ("0.2 mm", "0.45 mm", "100 %"):
            assert value in finding.message
        assert "=" not in finding.message  # all in that slicer's own words


def test_a_setting_without_a_name_of_the_slicers_own_is_said_in_prusaslicers():
    profile = load_profile(
        "fdm-pla-0.4",
        {
            "printer.layer_height_mm": 0.3,
            "wall_mm": 2.4,
            "slicer.object_settings.fill_density": "40%",
            "slicer.object_settings.support_material_buildplate_only": "0",
        },
    )
    (finding,) = format_findings(profile, Path("part.stl"), "orca")
    assert "fill_density=40% (PrusaSlicer's name)" in finding.message
    assert "Layer height 0.3 mm" in finding.message
    assert "Wall loops 3;" in finding.message
    assert "On build plate only" not in finding.message
    with pytest.raises(UsageError, match="is for resin"):
        check_slicer(load_profile("resin-standard"), "orca")
    check_slicer(load_profile("resin-standard"), "prusa")


def test_bare_formats_warn_of_the_settings_they_lose():
    fdm, resin = load_profile("fdm-pla-0.4"), load_profile("resin-standard")
    (finding,) = format_findings(fdm, Path("part.stl"))
    assert (finding.rule, finding.severity) == ("no-settings", "warning")
    assert "fill_density=100%" in finding.message
    assert not format_findings(fdm, Path("part.3MF"))
    assert not format_findings(resin, Path("part.stl"))  # no settings, nothing lost


def test_float32_is_all_a_file_holds(tmp_path: Path):
    result = hollow_result(size=20 / 3, wall=0.7)
    for suffix in SUFFIXES:
        path = tmp_path / f"part{suffix}"
        result.write(path)
        mesh = trimesh.load_mesh(path, process=False)
        corners = np.asarray(mesh.vertices, dtype=np.float64)
        if suffix == ".3mf":  # trimesh applies the item's place on the bed
            corners = corners - (125, 105, 0)
        expected, _ = quantized_arrays(result.part.manifold)
        found = np.unique(corners, axis=0)
        tolerance = 1e-5 if suffix == ".3mf" else 0.0
        assert found.shape == expected.shape
        np.testing.assert_allclose(found, expected, rtol=0, atol=tolerance)
