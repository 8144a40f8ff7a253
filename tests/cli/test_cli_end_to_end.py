"""The program as a user runs it: a real model in, a part out, the same bytes twice, and checked."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from pathlib import Path

import pytest
from manifold3d import Manifold

from printprep.mesh.write import to_bytes


def program(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "printprep", *arguments],
        capture_output=True, text=True, check=False, cwd=folder, encoding="utf-8", timeout=300,
    )  # fmt: skip


@pytest.fixture(scope="module")
def workshop(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("workshop")
    cylinder = Manifold.cylinder(30, 12, 12, 64)
    (folder / "cylinder.stl").write_bytes(to_bytes(cylinder, ".stl"))
    column = Manifold.cube((6, 6, 60))
    (folder / "column.stl").write_bytes(to_bytes(column, ".stl"))
    return folder


def test_a_cylinder_comes_out_hollow_checked_and_the_same_twice(workshop: Path):
    first = program("hollow", "cylinder.stl", "-o", "a.3mf", "--json", folder=workshop)
    assert (first.returncode, first.stderr) == (0, "")
    data = json.loads(first.stdout)
    # A prism over a 64-gon of circumradius 12: its area, and the edge it tips over.
    area = 32 * 144 * math.sin(2 * math.pi / 64)
    assert data["solid_mass_g"] == pytest.approx(area * 30 * 1.24e-3, rel=1e-5)
    assert data["tilt_solid_deg"] == pytest.approx(
        math.degrees(math.atan(12 * math.cos(math.pi / 64) / 15)), abs=1e-3
    )
    inner = 32 * (12 - 1.2) ** 2 * math.sin(2 * math.pi / 64)
    lightest_g = (area * 30 - inner * 27.6) * 1.24e-3
    # Never lighter than walls of the profile's less the tolerance, and close to them.
    held = data["supports"]
    assert (held["unsupported_mm2"], held["islands"]) == (0, 0)
    assert 0 < held["added_g"] < 0.4 * lightest_g
    assert 0.93 * lightest_g < data["mass_g"] - held["added_g"] < 1.1 * lightest_g
    assert data["wall_min_mm"] >= 1.15
    assert data["cavities"]["count"] == 1
    assert data["tilt_deg"] >= data["lean_deg"] == 10
    assert [item["rule"] for item in data["findings"]] == ["sealed-cavity"]

    assert program("hollow", "cylinder.stl", "-o", "b.3mf", folder=workshop).returncode == 0
    assert (workshop / "a.3mf").read_bytes() == (workshop / "b.3mf").read_bytes()

    checked = program("check", "a.3mf", "--json", folder=workshop)
    found = json.loads(checked.stdout)
    assert checked.returncode == 0
    assert found["mass_g"] == pytest.approx(data["mass_g"], rel=1e-5)
    assert found["wall_min_mm"] == pytest.approx(data["wall_min_mm"], abs=1e-3)
    assert found["tilt_deg"] == pytest.approx(data["tilt_deg"], abs=1e-3)


def test_a_lean_out_of_reach_is_an_error_finding_and_still_a_part(workshop: Path):
    line = ["hollow", "column.stl", "-o", "column.3mf", "--base", "never", "--lean", "30"]
    done = program(*line, "--json", folder=workshop)
    assert done.returncode == 0
    data = json.loads(done.stdout)
    (finding,) = [item for item in data["findings"] if item["severity"] == "error"]
    assert finding["rule"] == "lean-out-of-reach"
    assert finding["limit"] == 30
    assert data["reachable_deg"] == finding["value"] < 30
    assert (workshop / "column.3mf").is_file()

    (workshop / "column.3mf").unlink()
    stopped = program(*line, "--fail-on", "error", folder=workshop)
    assert stopped.returncode == 1
    assert "Not written" in stopped.stdout
    assert not (workshop / "column.3mf").exists()
