"""The real slicer, driven; and programs that only pretend to be one."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

from printprep.errors import InputError, OutputError, ToolError, UsageError
from printprep.profiles import load_profile
from printprep.slicer.child import INSTALL_HINT
from printprep.slicer.process import Slicer, find_slicer
from printprep.slicer.prusa_ini import profile_ini
from printprep.slicer.sanitize import settings_ini, without_commands

FACETS = [
    *("0 0 0, 0 9 0, 9 9 0", "0 0 0, 9 9 0, 9 0 0", "0 0 4, 9 0 4, 9 9 4", "0 0 4, 9 9 4, 0 9 4"),
    *("0 0 0, 9 0 0, 9 0 4", "0 0 0, 9 0 4, 0 0 4", "9 0 0, 9 9 0, 9 9 4", "9 0 0, 9 9 4, 9 0 4"),
    *("9 9 0, 0 9 0, 0 9 4", "9 9 0, 0 9 4, 9 9 4", "0 9 0, 0 0 0, 0 0 4", "0 9 0, 0 0 4, 0 9 4"),
]
posix_only = pytest.mark.skipif(sys.platform == "win32", reason="scripts with a first line")


@pytest.fixture
def block(tmp_path: Path) -> Path:
    """A 9 × 9 × 4 mm block as ASCII STL, under a name that is not plain."""
    path = tmp_path / "Blöckchen 木.stl"
    lines = ["solid block"]
    for facet in FACETS:
        corners = "".join(f"vertex {corner}\n" for corner in facet.split(", "))
        lines.append(f"facet normal 0 0 0\nouter loop\n{corners}endloop\nendfacet")
    path.write_text("\n".join([*lines, "endsolid block\n"]))
    return path


@pytest.fixture
def slicer(prusa_slicer: Path) -> Slicer:
    return find_slicer(prusa_slicer)


def pretend(folder: Path, body: str) -> Path:
    """A program that runs `body` as Python."""
    path = folder / "pretender"
    path.write_text(f"#!{sys.executable}\nimport os, subprocess, sys, time\n{body}\n")
    path.chmod(0o755)
    return path


@pytest.mark.slicer
def test_the_slicer_is_found_and_says_its_version(
    prusa_slicer: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = find_slicer()
    assert found.executable == prusa_slicer
    assert re.fullmatch(r"PrusaSlicer \d+\.\d+\.\d+", found.name)
    assert found.version >= (2, 3, 0)
    monkeypatch.setenv("PRINTPREP_SLICER", str(prusa_slicer))
    monkeypatch.setenv("PATH", "")
    assert find_slicer() == found


def test_a_missing_slicer_says_how_to_get_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("PRINTPREP_SLICER", raising=False)
    for path in (tmp_path / "none", tmp_path):
        with pytest.raises(ToolError) as caught:
            find_slicer(path)
        assert caught.value.hint == INSTALL_HINT
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("printprep.slicer.process._usual_places", lambda: [tmp_path / "none"])
    with pytest.raises(ToolError, match="was not found"):
        find_slicer()


@posix_only
def test_a_mac_application_folder_is_looked_into(tmp_path: Path) -> None:
    inner = tmp_path / "PrusaSlicer.app" / "Contents" / "MacOS"
    inner.mkdir(parents=True)
    pretend(inner, "print('PrusaSlicer-2.9.4+arm64 based on Slic3r')").rename(inner / "PrusaSlicer")
    found = find_slicer(tmp_path / "PrusaSlicer.app")
    assert found.version == (2, 9, 4)


@posix_only
@pytest.mark.parametrize("body", ["print('Hello')", "sys.exit(3)"])
def test_another_program_is_not_taken_for_it(tmp_path: Path, body: str) -> None:
    with pytest.raises(ToolError):
        find_slicer(pretend(tmp_path, body))


@posix_only
def test_a_run_past_its_limit_ends_with_all_it_started(tmp_path: Path, block: Path) -> None:
    marker = tmp_path / "late"
    child = f"import time; time.sleep(3); open({str(marker)!r}, 'w')"
    body = f"subprocess.Popen([sys.executable, '-c', {child!r}]); time.sleep(60)"
    hanging = Slicer(pretend(tmp_path, body), "PrusaSlicer 9.9.9", (9, 9, 9))
    began = time.monotonic()
    with pytest.raises(ToolError, match="stopped after 1 s"):
        hanging.slice(block, tmp_path / "a.gcode", timeout_seconds=1.0)
    assert time.monotonic() - began < 3.0
    time.sleep(3.5)
    assert not marker.exists()


@posix_only
def test_success_without_a_gcode_is_no_success(tmp_path: Path, block: Path) -> None:
    out = tmp_path / "a.gcode"
    out.write_text("old")
    silent = Slicer(
        pretend(tmp_path, "print('run hooks? answer: ', sys.stdin.read())"), "P", (9, 9, 9)
    )
    with pytest.raises(ToolError, match="wrote no G-code") as caught:
        silent.slice(block, out)
    assert caught.value.hint is not None
    assert "run hooks?" in caught.value.hint
    assert out.read_text() == "old"


@posix_only
def test_every_call_empties_the_hook_and_keeps_to_its_own_folder(
    tmp_path: Path, block: Path
) -> None:
    body = "open(os.environ['SAID'], 'w', encoding='utf-8').write(repr(sys.argv))\nsys.exit(1)"
    said = tmp_path / "said"
    speaking = Slicer(pretend(tmp_path, body), "P", (2, 5, 0))
    for call in (
        lambda: speaking.info(block),
        lambda: speaking.slice(block, tmp_path / "a.gcode", {"perimeters": "2"}),
    ):
        with pytest.MonkeyPatch.context() as patch:
            patch.setenv("SAID", str(said))
            with pytest.raises(ToolError, match="exit code 1"):
                call()
        arguments = ast.literal_eval(said.read_text(encoding="utf-8"))
        assert arguments[arguments.index("--post-process") + 1] == ""
        datadir = Path(arguments[arguments.index("--datadir") + 1])
        assert not datadir.exists()  # taken away with what the slicer left there


@pytest.mark.slicer
def test_info_of_a_block(slicer: Slicer, block: Path) -> None:
    info = slicer.info(block)
    assert info.manifold
    assert info.parts == 1
    assert info.volume_mm3 == pytest.approx(9 * 9 * 4)
    assert info.size_mm == (9.0, 9.0, 4.0)


@pytest.mark.slicer
def test_info_of_an_open_block_is_not_manifold(slicer: Slicer, block: Path, tmp_path: Path) -> None:
    holed = tmp_path / "holed.stl"
    text = block.read_text()
    start, end = text.index("facet"), text.index("endfacet") + len("endfacet")
    holed.write_text(text[:start] + text[end:])
    assert not slicer.info(holed).manifold


@pytest.mark.slicer
def test_a_block_is_sliced_where_it_lies_without_a_home(
    slicer: Slicer, block: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(tmp_path / "nowhere"))
    ini = tmp_path / "load.ini"
    ini.write_text("perimeters = 3\nskirts = 0\nlayer_height = 0.1\nfirst_layer_height = 0.2\n")
    done = slicer.slice(block, tmp_path / "out.gcode", {"layer_height": "0.2"}, ini)
    text = done.gcode.read_text()
    assert "; perimeters = 3\n" in text
    assert "; layer_height = 0.2\n" in text  # the settings go over what was loaded
    moves = re.findall(r"^G1 X([\d.-]+) Y([\d.-]+) E", text, re.MULTILINE)
    assert all(0.0 <= float(x) <= 9.0 and 0.0 <= float(y) <= 9.0 for x, y in moves)
    assert len(moves) > 100
    assert sorted(path.name for path in tmp_path.iterdir() if path.suffix == ".part") == []


@pytest.mark.slicer
def test_what_the_slicer_warns_of_is_handed_on(slicer: Slicer, block: Path, tmp_path: Path) -> None:
    """A second block that floats 3 mm over the first."""
    assert slicer.slice(block, tmp_path / "one.gcode").warnings == ()
    text = block.read_text()
    above = re.sub(r"(vertex \d \d) (\d)", lambda m: f"{m[1]} {int(m[2]) + 7}", text)
    both = tmp_path / "both.stl"
    both.write_text(text.replace("endsolid block\n", "") + above.removeprefix("solid block\n"))
    warnings = slicer.slice(both, tmp_path / "two.gcode").warnings
    assert warnings
    assert "warning" in warnings[0]


@pytest.mark.slicer
@pytest.mark.parametrize(
    "settings", [{"layer_height": "9"}, {"fill_pattern": "nonsense"}, {"layer_height": "thick"}]
)
def test_settings_that_cannot_be_are_an_error_and_leave_the_output(
    slicer: Slicer, block: Path, tmp_path: Path, settings: dict[str, str]
) -> None:
    out = tmp_path / "out.gcode"
    out.write_text("old")
    with pytest.raises(ToolError) as caught:
        slicer.slice(block, out, settings)
    assert caught.value.hint
    assert out.read_text() == "old"


@pytest.mark.slicer
def test_what_cannot_be_loaded_or_written_is_said(
    slicer: Slicer, block: Path, tmp_path: Path
) -> None:
    bad = tmp_path / "bad.stl"
    bad.write_text("garbage")
    with pytest.raises(ToolError):
        slicer.info(bad)
    with pytest.raises(InputError, match="does not exist"):
        slicer.info(tmp_path / "none.stl")
    with pytest.raises(InputError, match="not a model for a slicer"):
        slicer.info(Path(__file__))
    with pytest.raises(OutputError, match="cannot be written"):
        slicer.slice(block, tmp_path / "no folder" / "out.gcode")


def carriers(folder: Path, block: Path, command: str) -> dict[str, tuple[Path, Path | None]]:
    """Name → (model, file to load) that carry `command` as a hook."""
    ini = folder / "hook.ini"
    ini.write_text(f"layer_height = 0.2\npost_process = {command}\n")
    gcode = folder / "hook.gcode.pp"
    made = find_slicer().slice(block, folder / "made.gcode").gcode.read_text()
    assert "\n; post_process = \n" in made
    gcode.write_text(made.replace("; post_process = ", f"; post_process = {command}"))
    project = folder / "hook.3mf"
    # what a saved project holds beside the model
    subprocess.run(
        ["prusa-slicer", "--export-3mf", "-o", str(folder / "plain.3mf"), str(block)],
        check=True,
        capture_output=True,
    )
    with zipfile.ZipFile(folder / "plain.3mf") as plain, zipfile.ZipFile(project, "w") as loaded:
        for name in plain.namelist():
            loaded.writestr(name, plain.read(name))
        loaded.writestr(
            "Metadata/Slic3r_PE.config",
            f"; layer_height = 0.2\n; post_process = {command}\n; perimeters = 3\n",
        )
    return {"ini": (block, ini), "gcode": (block, gcode), "3mf": (project, None)}


@pytest.mark.slicer
@posix_only
@pytest.mark.parametrize("kind", ["ini", "gcode", "3mf"])
def test_commands_that_files_carry_never_run(
    slicer: Slicer, block: Path, tmp_path: Path, kind: str
) -> None:
    marker = tmp_path / "ran"
    model, load = carriers(tmp_path, block, f"/usr/bin/touch '{marker}' #")[kind]
    done = slicer.slice(model, tmp_path / "out.gcode", {}, load)
    slicer.info(model)
    assert not marker.exists()
    assert "touch" not in done.gcode.read_text()
    if kind == "3mf":
        assert "; perimeters = 3\n" in done.gcode.read_text()  # the rest of its config stays
    if kind == "ini" and slicer.version < (2, 7, 0):  # the same file, without our care
        command = ["prusa-slicer", "--load", str(load), "-g", "-o", str(tmp_path / "b.gcode")]
        subprocess.run([*command, str(model)], check=True, capture_output=True)
        assert marker.exists()


def test_copies_are_made_only_where_needed(tmp_path: Path, block: Path) -> None:
    assert without_commands(block, tmp_path) == block
    clean = tmp_path / "clean.3mf"
    with zipfile.ZipFile(clean, "w") as archive:
        archive.writestr("Metadata/Slic3r_PE.config", "; layer_height = 0.2\n")
    assert without_commands(clean, tmp_path) == clean
    with pytest.raises(InputError, match="cannot be read"):
        without_commands(tmp_path / "none.ini", tmp_path)
    broken = tmp_path / "broken.3mf"
    broken.write_bytes(b"PK")
    with pytest.raises(InputError, match="cannot be read"):
        without_commands(broken, tmp_path)


def test_keys_inside_a_model_config_go_too(tmp_path: Path) -> None:
    project = tmp_path / "a.3mf"
    config = '<config><object id="1"><metadata key="post_process" value="x"/><a/></object></config>'
    with zipfile.ZipFile(project, "w") as archive:
        archive.writestr("Metadata/Slic3r_PE_model.config", config)
        archive.writestr("3D/3dmodel.model", "<model/>")
    folder = tmp_path / "copies"
    folder.mkdir()
    with zipfile.ZipFile(without_commands(project, folder)) as copy:
        assert b"post_process" not in copy.read("Metadata/Slic3r_PE_model.config")
        assert copy.read("3D/3dmodel.model") == b"<model/>"


@pytest.mark.parametrize(
    "settings", [{"post_process": "x"}, {"a": "1\npost_process = x"}, {"a = 1\nb": "2"}, {"A": "1"}]
)
def test_settings_cannot_smuggle_in_commands(settings: dict[str, str]) -> None:
    with pytest.raises(UsageError):
        settings_ini(settings)


@pytest.mark.slicer
@pytest.mark.parametrize("name", ["fdm-pla-0.4", "fdm-petg-0.4", "fdm-pla-0.6"])
def test_the_slicer_takes_a_profile_as_it_is_meant(
    slicer: Slicer, block: Path, tmp_path: Path, name: str
) -> None:
    """Every line of the .ini is found again among the settings the G-code says it was made with."""
    profile = load_profile(name)
    ini = tmp_path / "profile.ini"
    ini.write_text(profile_ini(profile), encoding="utf-8")
    gcode = slicer.slice(block, tmp_path / "out.gcode", {}, ini).gcode.read_text()
    used = dict(re.findall(r"^; (\w+) = (.*)$", gcode, re.MULTILINE))
    asked = dict(re.findall(r"^(\w+) = (.*)$", ini.read_text(), re.MULTILINE))
    assert len(asked) > 25
    assert {key: used.get(key) for key in asked} == asked
    grams, cm3 = (
        float(re.search(rf"filament used \[{unit}\] = ([\d.]+)", gcode)[1])  # type: ignore[index]
        for unit in ("g", "cm3")
    )
    assert grams / cm3 == pytest.approx(profile.material.density_g_cm3, rel=0.03)
    layers = [float(z) for z in re.findall(r"^;Z:([\d.]+)$", gcode, re.MULTILINE)]
    assert layers[0] == pytest.approx(profile.printer.first_layer_mm)
    assert layers[1] - layers[0] == pytest.approx(profile.printer.layer_height_mm)


def test_the_ini_is_the_same_every_time_and_only_for_fdm() -> None:
    first = profile_ini(load_profile())
    assert first == profile_ini(load_profile())
    assert "post_process" not in first
    with pytest.raises(UsageError, match="is for resin"):
        profile_ini(load_profile("resin-standard"))
