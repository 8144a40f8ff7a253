"""A leaning box through the real slicer: its ballast holds it, and the file says what it is."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from collection import CatalogueModel
from infill_parts import FOOT, SHEAR, TALL, leaning, mesh_of, upright
from infill_table import infill_figures, markdown
from judges import read_strictly

from printprep import hollow
from printprep.cli.run import run
from printprep.errors import UsageError
from printprep.profiles import load_profile
from printprep.result import HollowResult
from printprep.slicer.process import find_slicer
from printprep.threemf.read import read_3mf
from printprep.verify.run import Verified, verify

# One worker makes the part for all of them
pytestmark = [pytest.mark.slicer, pytest.mark.xdist_group("infill part")]
LEAN = 14.0


@pytest.fixture(scope="module")
def made(prusa_slicer: Path) -> HollowResult:
    return hollow(
        mesh_of(leaning()),
        fill="infill",
        lean=LEAN,
        base="never",
        resolution=40,
        slicer=prusa_slicer,
    )


@pytest.fixture(scope="module")
def part(made: HollowResult, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("infill") / "part.3mf"
    made.write(path)
    return path


@pytest.fixture(scope="module")
def verified(part: Path, prusa_slicer: Path, tmp_path_factory: pytest.TempPathFactory) -> Verified:
    model = tmp_path_factory.mktemp("model") / "model.stl"
    mesh_of(leaning()).export(model)
    return verify(part, slicer=prusa_slicer, compare_with=model)


def test_it_stands_as_measured_and_has_nothing_to_spare(made: HollowResult):
    assert made.infill is not None and made.infill.slicer is not None
    assert made.infill.slicer.startswith("PrusaSlicer ")
    assert 2 <= made.infill.slices <= 6
    assert LEAN <= made.stability.tilt_deg <= LEAN + 0.5 + 0.3
    assert made.infill.ballast_g > 0.1
    assert made.findings == ()
    assert made.part.cavities == ()


def test_no_other_format_can_carry_it(made: HollowResult, tmp_path: Path):
    with pytest.raises(UsageError, match="cannot carry infill"):
        made.write(tmp_path / "part.stl")
    assert not list(tmp_path.iterdir())


def test_two_bodies_are_weighed_each_by_itself(prusa_slicer: Path):
    """Only the leaning one of two needs ballast, and the weaker of them is the one told."""
    two = leaning() + upright().translate((60.0, 0.0, 0.0))
    found = hollow(
        mesh_of(two), fill="infill", lean=LEAN, base="never", resolution=40, slicer=prusa_slicer
    )
    assert found.infill is not None and found.infill.slicer is not None
    assert LEAN <= found.stability.tilt_deg <= LEAN + 0.5 + 0.3
    (ballast,) = found.infill.ballast
    x_low, x_high = ballast.bounding_box()[0], ballast.bounding_box()[3]
    # On x = 0 lies the middle of the two, 40 mm from both ends
    assert -40 - 1e-3 < x_low < x_high < -40 + FOOT + SHEAR
    assert found.stability.centre_of_mass_mm[0] == pytest.approx(-40 + FOOT / 2 + 5, abs=1.5)


def test_lib3mf_reads_one_solid_and_its_ballast(part: Path):
    mesh, warnings = read_strictly(part, everything=True)
    assert warnings == []
    shells = trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).split()
    outside, ballast = sorted(shells, key=lambda shell: -shell.volume)
    assert outside.is_watertight and ballast.is_watertight
    assert outside.volume == pytest.approx(FOOT**2 * TALL, rel=1e-5)
    assert 0 < ballast.volume < outside.volume


def test_our_own_reader_leaves_the_ballast_out(part: Path):
    found = read_3mf(part)
    mesh = trimesh.Trimesh(found.vertices, found.faces, process=False)
    assert mesh.volume == pytest.approx(FOOT**2 * TALL, rel=1e-5)


def test_the_file_tells_the_slicer_what_is_what(part: Path):
    with zipfile.ZipFile(io.BytesIO(part.read_bytes())) as archive:
        config = archive.read("Metadata/Slic3r_PE_model.config").decode()
        said = json.loads(archive.read("Metadata/printprep.json"))
    head, modifier = config.split('value="ParameterModifier"/>')
    assert 'value="ModelPart"' in head
    assert 'key="fill_pattern" value="lightning"' in head
    assert 'key="fill_density" value="100%"' in modifier
    assert "support_material_buildplate_only" not in config
    assert said["infill"]["pattern"] == "lightning"
    assert said["infill"]["perimeters"] == 3
    assert "seconds" not in said


def test_the_slicer_takes_the_solid_for_a_solid(part: Path, prusa_slicer: Path):
    info = find_slicer(prusa_slicer).info(part)
    assert info.manifold
    np.testing.assert_allclose(info.size_mm[2], TALL, atol=1e-3)


def test_verify_agrees_and_speaks_of_no_cavities(verified: Verified):
    assert verified.findings == ()
    assert verified.part.cavities == ()
    assert verified.supported is None
    assert verified.printed.mass_g == pytest.approx(verified.part.mass_g, rel=1e-3)
    assert verified.printed.tilt_deg == pytest.approx(verified.part.tilt_deg, abs=0.02)


def test_the_uniform_infills_of_the_same_walls_fall_short(verified: Verified):
    gyroid, lightning = verified.baselines
    assert gyroid.mass_g > lightning.mass_g
    assert max(gyroid.tilt_deg, lightning.tilt_deg) < LEAN
    assert verified.printed.mass_g > lightning.mass_g


def test_the_command_says_how_it_was_weighed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    mesh_of(leaning()).export("box.stl")
    line = "hollow box.stl --fill infill --resolution 32 --set infill.pattern=gyroid"
    assert run([*line.split(), "--base", "never", "--verify"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "15% gyroid, 3 perimeters; no ballast needed" in out
    assert "in the G-code of PrusaSlicer" in out
    assert Path("box-hollow.3mf").is_file()


@pytest.mark.corpus
def test_a_real_model_stands_for_the_grams_of_lightning(
    dev_models: dict[str, CatalogueModel], prusa_slicer: Path
):
    """One row of the table in docs/infill.md, smaller."""
    model = dev_models["spot_low_resolution"]
    options = {"up": model.up, "size_mm": 50.0, "lean": 15.0, "base": "auto"}
    row = infill_figures(model.path, load_profile(), options)
    assert "printed" not in row["findings"] and not row["estimated"]
    assert row["infill_deg"] >= 15.0
    assert row["infill_deg"] == pytest.approx(row["told_deg"], abs=0.2)
    assert row["infill_g"] == pytest.approx(row["told_g"], rel=0.005)
    assert row["lightning_deg"] < 0 and row["gyroid_deg"] < 0
    assert row["infill_g"] < 1.10 * row["lightning_g"] < row["gyroid_g"]
    assert "1 of 1 stand" in markdown([{"model": model.path.stem, **row}])
