"""The program as a user runs it: a real model in, a part out, the same bytes twice, and checked."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from manifold3d import Manifold

from printprep.mesh.write import to_bytes

# One worker hollows a cylinder for all that ask for it
on_one_worker = pytest.mark.xdist_group("hollowed cylinder")


def program(*arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "printprep", *arguments],
        capture_output=True, encoding="utf-8", check=False, cwd=folder, timeout=300,
    )  # fmt: skip


@dataclass(frozen=True)
class Bench:
    """A folder with a prism over a 64-gon, hollowed once to a.3mf.

    radius_mm : the circumradius;  data : what --json said of the part.
    """

    folder: Path
    radius_mm: float
    height_mm: float
    data: dict[str, Any]


@pytest.fixture(
    scope="module",
    params=[(6.0, 15.0), pytest.param((12.0, 30.0), marks=pytest.mark.slow)],
    ids=["small", "large"],
)
def bench(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Bench:
    radius_mm, height_mm = request.param
    folder = tmp_path_factory.mktemp("bench")
    cylinder = Manifold.cylinder(height_mm, radius_mm, radius_mm, 64)
    (folder / "cylinder.stl").write_bytes(to_bytes(cylinder, ".stl"))
    done = program("hollow", "cylinder.stl", "-o", "a.3mf", "--json", folder=folder)
    assert (done.returncode, done.stderr) == (0, "")
    return Bench(folder, radius_mm, height_mm, json.loads(done.stdout))


@on_one_worker
def test_a_cylinder_comes_out_hollow(bench: Bench):
    radius_mm, height_mm, data = bench.radius_mm, bench.height_mm, bench.data
    # Its area, and the edge it tips over
    area = 32 * radius_mm**2 * math.sin(2 * math.pi / 64)
    assert data["solid_mass_g"] == pytest.approx(area * height_mm * 1.24e-3, rel=1e-5)
    assert data["tilt_solid_deg"] == pytest.approx(
        math.degrees(math.atan(radius_mm * math.cos(math.pi / 64) / (height_mm / 2))), abs=1e-3
    )
    inner = 32 * (radius_mm - 1.2) ** 2 * math.sin(2 * math.pi / 64)
    lightest_g = (area * height_mm - inner * (height_mm - 2.4)) * 1.24e-3
    # Never lighter than walls of the profile's less the tolerance, and close to them.
    held = data["supports"]
    assert (held["unsupported_mm2"], held["islands"]) == (0, 0)
    assert 0 < held["added_g"] < 0.4 * lightest_g
    assert 0.93 * lightest_g < data["mass_g"] - held["added_g"] < 1.1 * lightest_g
    assert data["wall_min_mm"] >= 1.15
    assert data["cavities"]["count"] == 1
    assert data["tilt_deg"] >= data["lean_deg"] == 10
    assert [item["rule"] for item in data["findings"]] == ["sealed-cavity"]


@on_one_worker
def test_the_same_input_gives_the_same_bytes(bench: Bench):
    assert program("hollow", "cylinder.stl", "-o", "b.3mf", folder=bench.folder).returncode == 0
    assert (bench.folder / "a.3mf").read_bytes() == (bench.folder / "b.3mf").read_bytes()


@on_one_worker
def test_check_finds_the_figures_that_hollow_gave(bench: Bench):
    checked = program("check", "a.3mf", "--json", folder=bench.folder)
    found = json.loads(checked.stdout)
    assert checked.returncode == 0
    assert found["mass_g"] == pytest.approx(bench.data["mass_g"], rel=1e-5)
    assert found["wall_min_mm"] == pytest.approx(bench.data["wall_min_mm"], abs=1e-3)
    assert found["tilt_deg"] == pytest.approx(bench.data["tilt_deg"], abs=1e-3)


COLUMN = ["hollow", "column.stl", "-o", "column.3mf", "--base", "never", "--lean", "30"]


@pytest.fixture
def column(tmp_path: Path) -> Path:
    """A folder with a column that no filling makes stand at 30°."""
    (tmp_path / "column.stl").write_bytes(to_bytes(Manifold.cube((6, 6, 60)), ".stl"))
    return tmp_path


def test_a_lean_out_of_reach_is_an_error_finding_and_still_a_part(column: Path):
    done = program(*COLUMN, "--json", folder=column)
    assert done.returncode == 0
    data = json.loads(done.stdout)
    errors = {item["rule"]: item for item in data["findings"] if item["severity"] == "error"}
    assert set(errors) == {"lean-out-of-reach", "tilt"}
    finding = errors["lean-out-of-reach"]
    assert finding["limit"] == 30
    assert data["reachable_deg"] == finding["value"] < 30
    assert (column / "column.3mf").is_file()


def test_a_lean_out_of_reach_writes_nothing_where_errors_may_not_be(column: Path):
    stopped = program(*COLUMN, "--fail-on", "error", folder=column)
    assert stopped.returncode == 1
    assert "Not written" in stopped.stdout
    assert not (column / "column.3mf").exists()
