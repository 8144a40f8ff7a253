"""``printprep check`` on files: the same rules, its own exit codes, nothing written."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from closed_form_parts import box, hollow_box, hollow_result

from printprep.cli.run import run
from printprep.mesh.write import to_bytes
from printprep.output.part_file import write_part


def write(folder: Path, part, name: str = "part.stl") -> str:
    path = folder / name
    path.write_bytes(to_bytes(part, path.suffix))
    return str(path)


def checked(capsys, *arguments: str) -> tuple[int, dict]:
    code = run(["check", *arguments, "--json"])
    return code, json.loads(capsys.readouterr().out)


@pytest.mark.parametrize("suffix", ["stl", "obj", "ply"])
def test_figures_of_a_hollow_block(tmp_path, capsys, suffix):
    code, data = checked(capsys, write(tmp_path, hollow_box(20, 2), f"part.{suffix}"))
    assert code == 0
    assert data["volume_mm3"] == pytest.approx(3904, rel=1e-6)
    assert data["wall_min_mm"] == pytest.approx(2, rel=1e-6)
    assert data["tilt_deg"] == pytest.approx(45)
    assert data["cavities"]["items"] == [
        {"volume_mm3": 4096.0, "bounds_mm": [[-8.0, -8.0, 2.0], [8.0, 8.0, 18.0]]}
    ]
    assert data["repair"]["rung"] == "as-is"
    assert [item["rule"] for item in data["findings"]] == ["unsupported-ceiling", "sealed-cavity"]


def test_what_hollow_writes_passes(tmp_path, capsys):
    path = tmp_path / "part.3mf"
    write_part(hollow_result(with_base=True).contents(), path)
    before = path.read_bytes()
    code, data = checked(capsys, str(path))
    assert code == 0
    assert data["volume_mm3"] == pytest.approx(3904 + 176, rel=1e-6)
    assert data["wall_min_mm"] == pytest.approx(2, rel=1e-6)
    assert path.read_bytes() == before


@pytest.mark.parametrize(
    ("more", "code", "rules"),
    [
        ((), 0, []),
        (("--lean", "50"), 1, ["tilt"]),
        (("--lean", "50", "--fail-on", "none"), 0, ["tilt"]),
        (("--scale", "20"), 1, ["fits-bed"]),
        (("--size", "0.5"), 1, ["tiny-model"]),
        (("--set", "printer.bed_mm=[15, 30, 30]"), 1, ["fits-bed"]),
    ],
)
def test_options_reach_the_rules(tmp_path, capsys, more, code, rules):
    found, data = checked(capsys, write(tmp_path, box(20)), *more)
    assert (found, [item["rule"] for item in data["findings"]]) == (code, rules)


def test_wall_and_process_decide(tmp_path, capsys):
    path = write(tmp_path, hollow_box(20, 2))
    code, data = checked(capsys, path, "--wall", "2.5")
    assert code == 1
    assert data["findings"][0]["rule"] == "wall-thickness"
    assert checked(capsys, path, "-p", "sls-pa12")[0] == 1
    assert checked(capsys, path, "--fail-on", "info")[0] == 1


def test_an_open_surface_is_repaired_to_be_judged_and_said_to_be_open(tmp_path, capsys):
    content = to_bytes(box(20), ".stl")
    count = int.from_bytes(content[80:84], "little") - 1
    path = tmp_path / "open.stl"
    path.write_bytes(content[:80] + count.to_bytes(4, "little") + content[84:-50])
    code, data = checked(capsys, str(path))
    assert code == 1
    assert data["repair"]["rung"] in ("meshlab", "remesh")
    assert "repaired" in [item["rule"] for item in data["findings"]]


def test_summary_and_quiet(tmp_path, capsys):
    path = write(tmp_path, box(20))
    assert run(["check", path, "--lean", "50"]) == 1
    assert "tips at" in capsys.readouterr().out
    assert run(["check", path, "--lean", "50", "-q"]) == 1
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("printprep: error: The part tips over at 45.0°")
    assert run(["check", path, "-v"]) == 0
    assert "triangles" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("content", "name"), [(b"", "empty.stl"), (b"nonsense", "x.stl"), (None, "missing.obj")]
)
def test_unreadable_files(tmp_path, capsys, content, name):
    path = tmp_path / name
    if content is not None:
        path.write_bytes(content)
    assert run(["check", str(path)]) == 3
    err = capsys.readouterr().err
    assert err.startswith(f"printprep: error: {path}")
    assert "Traceback" not in err


def test_a_lean_beyond_reason_is_usage(tmp_path):
    assert run(["check", write(tmp_path, box(20)), "--lean", "61"]) == 2
