"""PrusaSlicer runs the hook: as a user's config has it, from the slicer's own command line."""

from __future__ import annotations

import io
import json
import os
import re
import signal
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
import trimesh
from verify_parts import SIDE, write_block, write_model

from printprep.cli.run import run
from printprep.gcode.measure import measure_gcode
from printprep.hook.command_line import setting_line
from printprep.hook.gcode_file import MARK
from printprep.profiles import load_profile
from printprep.slicer.process import find_slicer
from printprep.slicer.prusa_ini import profile_settings
from printprep.slicer.sanitize import settings_ini
from printprep.threemf.write import Item, Volume, write_3mf

# One worker slices the block for all of them
pytestmark = [pytest.mark.slicer, pytest.mark.xdist_group("hooked block")]
ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def leaning(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A square prism sheared by 14 mm over 30: the solid tips over at 3.8° and should stand 10°."""
    prism = trimesh.creation.box((16, 16, 30))
    points = np.array(prism.vertices) + np.array([0, 0, 15])
    points[:, 0] += points[:, 2] * 14 / 30
    path = tmp_path_factory.mktemp("leaning") / "leaning prism.stl"
    trimesh.Trimesh(points, prism.faces).export(path)
    return path


def config(folder: Path, *options: str, **changes: str) -> Path:
    """The default profile's settings, changed, with the hook as post_process."""
    settings = {**profile_settings(load_profile()), **changes}
    path = folder / "with-hook.ini"
    # In an .ini, a script with blanks and quotes is a quoted string
    line = setting_line(list(options)).replace("\\", "\\\\").replace('"', '\\"')
    path.write_text(f'{settings_ini(settings)}post_process = "{line}"\n', encoding="utf-8")
    return path


def slice_with_hook(slicer: Path, model: Path, ini: Path) -> tuple[int, str, Path]:
    """Exit code, what was said, and the G-code, of the slicer run as a user runs it."""
    out = ini.with_name("out.gcode")
    own = ini.with_name("datadir")
    own.mkdir()
    command = [str(slicer), "--datadir", str(own), "--export-gcode", "--load", str(ini)]
    command += ["--center", "100,100", "--output", str(out), str(model)]
    done = subprocess.run(
        command, capture_output=True, encoding="utf-8", check=False, stdin=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": str(ROOT)}, timeout=300,
    )  # fmt: skip
    return done.returncode, done.stdout + done.stderr, out


def notes_of(path: Path) -> dict[str, str]:
    lines = [line for line in path.read_bytes().splitlines() if line.startswith(MARK)]
    return dict(line[len(MARK) :].decode().split(" = ", 1) for line in lines)


def test_the_slicers_own_run_annotates(prusa_slicer: Path, leaning: Path, tmp_path: Path):
    code, said, out = slice_with_hook(prusa_slicer, leaning, config(tmp_path))
    assert code == 0, said
    notes = notes_of(out)
    assert notes["stands"] == "no"
    # Toward +x: 8 mm of foot, of which the middle has used up 7, at half of 30 mm
    assert float(notes["tilt_deg"]) == pytest.approx(np.degrees(np.arctan2(1.0, 15.0)), abs=0.5)
    assert float(notes["mass_g"]) == pytest.approx(16 * 16 * 30 * 1.24e-3, rel=0.03)


def test_strict_makes_the_slicer_report_a_failure(
    prusa_slicer: Path, leaning: Path, tmp_path: Path
):
    code, said, _ = slice_with_hook(prusa_slicer, leaning, config(tmp_path, "--strict"))
    assert code != 0
    assert "tips over at" in said and "printprep" in said
    (tmp_path / "block").mkdir()
    block = write_model(tmp_path / "block")
    upright = config(tmp_path / "block", "--strict")
    code, said, out = slice_with_hook(prusa_slicer, block, upright)
    assert code == 0, said
    assert notes_of(out)["stands"] == "yes"


def test_reslicing_replaces_the_print_by_a_lighter_one_that_stands(
    prusa_slicer: Path, leaning: Path, tmp_path: Path
):
    ini = config(tmp_path, "--reslice", "--model", str(leaning), layer_height="0.25")
    code, said, out = slice_with_hook(prusa_slicer, leaning, ini)
    assert code == 0, said
    printed = measure_gcode(out)
    notes = notes_of(out)
    solid_g = 16 * 16 * 30 * 1.24e-3
    assert float(notes["replaced_mass_g"]) == pytest.approx(solid_g, rel=0.03)
    assert printed.mass_g == pytest.approx(float(notes["computed_mass_g"]), rel=0.04)
    assert printed.mass_g < 0.9 * solid_g
    assert printed.tilt_deg > 9.0
    assert notes["in_cavities_mm3"] == "0.00"
    assert notes["stands"] == "yes"
    # With the settings of the user, in the place of the print, as one slice
    assert printed.slicer_summary.settings["layer_height"] == "0.25"
    assert printed.slicer_summary.settings["post_process"] == ""
    assert printed.bounds_mm.mean(axis=0)[:2] == pytest.approx((100, 100), abs=3.1)  # with a base
    assert printed.filament_mm3 == pytest.approx(printed.slicer_summary.filament_mm3, rel=0.005)


@pytest.fixture(scope="module")
def block_gcode(
    prusa_slicer: Path, tmp_path_factory: pytest.TempPathFactory
) -> tuple[Path, Path, Path]:
    """A block's G-code as the slicer left it, the model, and the part made of it."""
    folder = tmp_path_factory.mktemp("sliced")
    model, part, out = write_model(folder), write_block(folder), folder / "solid.gcode"
    find_slicer(prusa_slicer).slice(model, out, profile_settings(load_profile()))
    return out, model, part


def test_more_than_the_model_is_not_lost(
    block_gcode: tuple[Path, Path, Path], prusa_slicer: Path, tmp_path: Path, capsys
):
    """Settings of the object's own, and another size, leave the G-code alone."""
    _, model, _ = block_gcode
    settings = {**profile_settings(load_profile()), "fill_density": "15%", "fill_pattern": "grid"}
    gcode = tmp_path / "mine.gcode"
    # The object's own keys say 100 %, the config in the G-code says 15 %
    with_keys = tmp_path / "solid-with-keys.3mf"
    mesh = trimesh.load(model)
    volume = Volume("block", mesh.vertices + np.array([100, 100, 12]), np.array(mesh.faces))
    keys = {"fill_density": "100%", "fill_pattern": "rectilinear"}
    with_keys.write_bytes(write_3mf([Item("block", [volume], keys)]))
    find_slicer(prusa_slicer).slice(with_keys, gcode, settings)
    before = gcode.read_bytes()
    assert run(["hook", "--reslice", "--model", str(model), str(gcode)]) == 3
    assert "prints differently" in capsys.readouterr().err
    assert gcode.read_bytes() == before
    smaller = ["--size", str(SIDE - 4)]
    assert run(["hook", "--reslice", "--model", str(model), *smaller, str(gcode)]) == 3
    assert "another size" in capsys.readouterr().err
    assert gcode.read_bytes() == before


def with_painted_supports(content: bytes) -> bytes:
    """A 3MF with every triangle painted as PrusaSlicer's brush for supports paints it."""
    painted = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as old, zipfile.ZipFile(painted, "w") as new:
        for name in old.namelist():
            part = re.sub(
                rb"(<triangle [^>]*?)/>", rb'\1 slic3rpe:custom_supports="4"/>', old.read(name)
            )
            new.writestr(name, part)
    return painted.getvalue()


def lossy(case: str, model: Path) -> tuple[bytes, dict[str, str], str]:
    """A 3MF of which the G-code keeps less than slicing needs; settings; why it is refused."""
    mesh = trimesh.load(model)
    low, size = mesh.bounds[0], mesh.extents
    points, faces = mesh.vertices - low + [80, 80, 0], np.array(mesh.faces)
    whole = Volume("model", points, faces)
    middle = points.mean(axis=0)
    if case == "modifier":
        core = Volume(
            "m",
            middle + (points - middle) * 0.6,
            faces,
            "ParameterModifier",
            {"fill_density": "15%", "fill_pattern": "grid"},
        )
        return write_3mf([Item("i", [whole, core])]), {}, "prints differently"
    if case == "painting":
        on = {"support_material": "1", "support_material_auto": "0"}
        return with_painted_supports(write_3mf([Item("i", [whole])])), on, "prints differently"
    if case.startswith("objects"):
        label = {"gcode_label_objects": "1" if case == "objects, labelled" else "0"}
        both = write_3mf([Item("a", [whole]), Item("b", [whole], {}, (2 * size[0], 0, 0))])
        return both, label, "2 objects" if case == "objects, labelled" else "another size"
    assert case == "wipe tower"
    scale = np.array([1, 1, 0.5])
    low = Volume("low", points * scale, faces, settings={"extruder": "1"})
    high = Volume("high", points * scale + [0, 0, size[2] / 2], faces, settings={"extruder": "2"})
    settings = profile_settings(load_profile())
    keys = ("nozzle_diameter", "filament_density", "filament_diameter", "extrusion_multiplier")
    tower = {key: f"{settings[key]},{settings[key]}" for key in keys} | {
        "filament_type": "PLA;PLA", "max_layer_height": "0.3,0.3", "wipe_tower": "1",
        "single_extruder_multi_material": "1", "use_relative_e_distances": "1",
    }  # fmt: skip
    return write_3mf([Item("i", [low, high])]), tower, "wipe tower"


@pytest.mark.parametrize(
    "case", ["modifier", "painting", "objects, labelled", "objects", "wipe tower"]
)
def test_what_reslicing_would_lose_leaves_the_gcode_as_it_was(
    case: str, leaning: Path, prusa_slicer: Path, tmp_path: Path, capsys
):
    content, changes, why = lossy(case, leaning)
    source, gcode = tmp_path / "source.3mf", tmp_path / "mine.gcode"
    source.write_bytes(content)
    settings = {**profile_settings(load_profile()), **changes}
    find_slicer(prusa_slicer).slice(source, gcode, settings)
    before = gcode.read_bytes()
    assert run(["hook", "--reslice", "--model", str(leaning), str(gcode)]) == 3
    assert why in capsys.readouterr().err
    assert gcode.read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["mine.gcode", "source.3mf"]


def test_the_slicer_shows_a_refusal(prusa_slicer: Path, leaning: Path, tmp_path: Path):
    content, changes, why = lossy("objects, labelled", leaning)
    source = tmp_path / "two.3mf"
    source.write_bytes(content)
    ini = config(tmp_path, "--reslice", "--model", str(leaning), **changes)
    code, said, _ = slice_with_hook(prusa_slicer, source, ini)
    assert code != 0
    assert why in said


def test_compared_with_its_part_wherever_it_lies(
    block_gcode: tuple[Path, Path, Path], prusa_slicer: Path, tmp_path: Path, capsys
):
    solid, _, part = block_gcode
    gcode = tmp_path / "of-the-part.gcode"
    find_slicer(prusa_slicer).slice(part, gcode, profile_settings(load_profile()))
    assert run(["hook", "--part", str(part), str(gcode)]) == 0
    notes = notes_of(gcode)
    assert notes["findings"] == "none"
    with zipfile.ZipFile(part) as archive:
        mass_g = json.loads(archive.read("Metadata/printprep.json"))["mass_g"]
    assert float(notes["computed_mass_g"]) == pytest.approx(mass_g, abs=1e-3)
    # The solid block's G-code fills what the part has hollow
    copy = tmp_path / "solid.gcode"
    copy.write_bytes(solid.read_bytes())
    assert run(["hook", "--part", str(part), "--strict", str(copy)]) == 1
    assert "inside cavities" in capsys.readouterr().err
    assert copy.read_bytes() == solid.read_bytes()


KILLED = """
import os, signal, sys
from pathlib import Path
import printprep.hook.reslice as reslicing

def die(*_args, **_options):
    os.kill(os.getpid(), signal.SIGKILL)
setattr(reslicing, sys.argv[1], die)
reslicing.reslice(Path(sys.argv[2]), Path(sys.argv[3]))
"""


@pytest.mark.skipif(sys.platform == "win32", reason="kills as POSIX does")
@pytest.mark.parametrize("point", ["_sliced_as_it_is", "replace_content"])
def test_killed_while_reslicing_the_file_is_the_old_one(
    block_gcode: tuple[Path, Path, Path], tmp_path: Path, point: str
):
    solid, model, _ = block_gcode
    gcode = tmp_path / "print.gcode.pp"
    gcode.write_bytes(solid.read_bytes())
    command = [sys.executable, "-c", KILLED, point, str(gcode), str(model)]
    done = subprocess.run(command, check=False, env={**os.environ, "PYTHONPATH": str(ROOT)})
    assert done.returncode == -signal.SIGKILL
    assert gcode.read_bytes() == solid.read_bytes()
    assert [path.name for path in tmp_path.iterdir()] == [gcode.name]
