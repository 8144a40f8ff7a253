"""The curve of mass against lean: monotone, convex in what it costs, ending where the lean ends."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import solids
import trimesh

from printprep.cli import main
from printprep.mesh.measure import arrays
from printprep.pipeline.explore import Exploration, explore
from printprep.pipeline.hollow import hollow
from printprep.pipeline.options import FillOptions
from printprep.report.chart import chart

# One worker explores the prism for all of them
pytestmark = pytest.mark.xdist_group("explored prism")


@pytest.fixture(scope="module")
def prism(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("explore") / "prism.stl"
    trimesh.Trimesh(*arrays(solids.leaning_prism(20, 60, 20)), process=False).export(path)
    return path


@pytest.fixture(scope="module")
def found(prism: Path) -> Exploration:
    return explore(prism, options=FillOptions(base="never", resolution=32), count=6)


def test_more_lean_never_weighs_less(found: Exploration) -> None:
    masses = [point.mass_g for point in found.points]
    leans = [point.lean_deg for point in found.points]
    assert leans == pytest.approx(np.linspace(0, found.reachable_deg, 6).tolist())
    assert masses == sorted(masses)
    assert masses[0] < masses[-1]
    assert all(point.gap <= 1e-6 for point in found.points)


def test_a_point_is_what_hollow_finds(found: Exploration, prism: Path) -> None:
    point = found.points[2]
    result = hollow(
        prism,
        base="never",
        resolution=32,
        lean=point.lean_deg,
        overrides={"stability.lean_margin_deg": 0.0},
    )
    certificate = result.density.certificate
    assert certificate is not None
    # Solved again a little higher where surfacing lost some lean: never lighter, hardly heavier.
    assert point.mass_g * (1 - 1e-6) <= certificate.voxel_mass_g <= point.mass_g * 1.01


def test_marks_are_the_solid_the_shell_and_the_paper(found: Exploration) -> None:
    by_name = {mark.name: mark for mark in found.marks}
    assert by_name["solid"].mass_g == pytest.approx(20 * 20 * 60 * 1.24 / 1000)
    assert by_name["shell alone"].mass_g < by_name["paper's objective"].mass_g * 1.001
    assert by_name["solid"].mass_g > by_name["paper's objective"].mass_g


def test_the_chart_is_the_same_every_time_in_both_forms(found: Exploration) -> None:
    drawing = chart(found)
    assert drawing.svg() == chart(found).svg()
    assert drawing.png() == chart(found).png()
    assert drawing.svg().count(b"<circle") == len(found.points) + len(found.marks)
    assert drawing.png().startswith(b"\x89PNG")


def test_the_command_prints_json_and_draws(
    prism: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    target = tmp_path / "curve.svg"
    line = ["explore", str(prism), "--resolution", "24", "--points", "3", "--base", "never"]
    with pytest.raises(SystemExit) as ended:
        main([*line, "--chart", str(target), "--json"])
    assert ended.value.code == 0
    said = json.loads(capsys.readouterr().out)
    assert len(said["curve"]) == 3
    assert target.read_bytes().startswith(b"<svg")


def test_a_chart_of_another_kind_is_refused_before_the_work(
    prism: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["explore", str(prism), "--chart", str(tmp_path / "curve.gif")])
    assert ended.value.code == 2
    assert "--chart writes only .svg or .png" in capsys.readouterr().err
