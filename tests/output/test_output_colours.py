"""The colours of a model on the outside of its part: carried, or named as lost."""

from __future__ import annotations

import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest
from manifold3d import Manifold

from printprep.check import at_or_above
from printprep.mesh.carry import carried, facets_apart
from printprep.mesh.measure import arrays
from printprep.output.colours import colour_findings
from printprep.pipeline.job import Job, run_job
from printprep.pipeline.options import FillOptions, Placement
from printprep.threemf.read import read_3mf
from printprep.threemf.write import Item, Volume, write_3mf
from printprep.types import PLAIN, Material, Paint, Style

QUICK = FillOptions(resolution=12, self_support=False, base="never")
RED, BLUE = Style(Material("red", "#FF0000")), Style(Material("blue", "#0000FF"))
PAINTED = Style(None, (("colour", "8"),))
SPLIT = Style(None, (("colour", "8046"),))  # a triangle of several pieces: its last digit is 6


def cube(side: float, cells: int = 1) -> tuple[np.ndarray, np.ndarray]:
    return arrays(Manifold.cube((side, side, side)).refine(cells))


def areas(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    a, b, c = (vertices[faces[:, index]] for index in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2


def area_by_style(paint: object, vertices: np.ndarray, faces: np.ndarray) -> dict[Style, float]:
    found: dict[Style, float] = {}
    for label, area in zip(paint.labels.tolist(), areas(vertices, faces).tolist(), strict=True):  # type: ignore[attr-defined]
        style = paint.styles[label]  # type: ignore[attr-defined]
        found[style] = found.get(style, 0.0) + area
    return found


def left_and_right(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """1 for the faces left of the middle, 2 for the others."""
    middle = (vertices[:, 0].min() + vertices[:, 0].max()) / 2
    return np.where(vertices[faces].mean(axis=1)[:, 0] < middle, 1, 2)


def test_each_facet_takes_the_colour_that_it_lies_on() -> None:
    """A cube with colours in two halves, hollow, on a base: closed-form areas."""
    vertices, faces = cube(20, 4)
    paint = Paint((PLAIN, RED, BLUE), left_and_right(vertices, faces))
    hole = Manifold.cube((12, 12, 12)).translate((4, 4, 4))
    base = Manifold.cube((24, 24, 1)).translate((-2, -2, -1))
    part = facets_apart(Manifold.cube((20, 20, 20)).refine(4)) + base - hole
    assert part.volume() == pytest.approx(20**3 - 12**3 + 24**2)
    to_vertices, to_faces = arrays(part)
    found = carried(paint, vertices, faces, to_vertices, to_faces)
    by_style = area_by_style(found, to_vertices, to_faces)
    # Half of the top, one side, half of two more; the base covers the underside.
    assert by_style[RED] == pytest.approx(200 + 400 + 400)
    assert by_style[BLUE] == pytest.approx(200 + 400 + 400)
    assert by_style[PLAIN] == pytest.approx(6 * 12**2 + 24**2 + 4 * 24 + 24**2 - 20**2)
    assert (found.lost_mm2, found.painted_mm2) == (0, pytest.approx(2000))


def test_codes_that_split_a_triangle_stay_with_a_triangle_that_is_whole() -> None:
    vertices, faces = cube(20, 4)
    labels = np.zeros(len(faces), dtype=np.int64)
    top = (vertices[faces][:, :, 2] > 19.9).all(axis=1)
    labels[top] = 1
    paint = Paint((PLAIN, SPLIT), labels)
    turned = np.roll(faces, 1, axis=1)
    found = carried(paint, vertices, faces, vertices, turned)
    assert (found.labels == labels).all()
    assert (found.turns[top] == 1).all()
    again = np.take_along_axis(turned, (np.arange(3) + found.turns[:, None]) % 3, axis=1)
    assert (again[top] == faces[top]).all()
    assert found.lost_mm2 == 0
    coarse = carried(paint, vertices, faces, *cube(20))
    assert [coarse.styles[label] for label in coarse.labels] == [PLAIN] * 12
    assert coarse.lost_mm2 == pytest.approx(400) == coarse.painted_mm2


def test_a_facet_of_two_colours_takes_the_larger_and_says_so() -> None:
    vertices, faces = cube(20, 4)
    labels = np.where(vertices[faces].mean(axis=1)[:, 0] < 5, 1, 2)
    paint = Paint((PLAIN, RED, BLUE), labels)
    found = carried(paint, vertices, faces, *cube(20))
    assert found.lost_mm2 > 100
    assert found.painted_mm2 == pytest.approx(2400)
    (said,) = colour_findings(found, Path("a.3mf"))
    assert (said.rule, said.severity) == ("colours-lost", "warning")


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cube of 40 mm, red on the left, blue and painted on the right."""
    vertices, faces = cube(40, 4)
    styles = (PLAIN, RED, Style(BLUE.material, PAINTED.strokes))
    paint = Paint(styles, left_and_right(vertices, faces))
    path = tmp_path_factory.mktemp("colours") / "cube.3mf"
    path.write_bytes(write_3mf([Item("cube", [Volume("cube", vertices, faces, paint=paint)])]))
    return path


def test_hollow_keeps_the_colours_of_the_outside(model: Path, tmp_path: Path) -> None:
    placement = Placement(up="+x", scale=1.25)
    job = Job(model, tmp_path / "out.3mf", placement=placement, options=QUICK)
    done = run_job(job)
    assert not [item for item in done.findings if item.rule == "colours-lost"]
    found = read_3mf(job.output)
    assert found.paint is not None
    by_style = area_by_style(found.paint, found.vertices, found.faces)
    outside = 6 * 50**2 / 2
    painted = sum(area for style, area in by_style.items() if style.strokes)
    assert painted == pytest.approx(outside, rel=1e-6)
    z = found.vertices[found.faces].mean(axis=1)[:, 2]
    strokes = np.array([bool(found.paint.styles[label].strokes) for label in found.paint.labels])
    assert z[strokes].min() > 25 - 1e-3  # +x is up: the right half is the upper one


def test_a_format_without_colours_says_so(model: Path, tmp_path: Path) -> None:
    done = run_job(Job(model, tmp_path / "out.stl", options=QUICK))
    (said,) = [item for item in done.findings if item.rule == "colours-lost"]
    assert said.severity == "warning"
    assert "A .stl file holds no colours" in said.message
    result = done.result
    assert [item.rule for item in colour_findings(result.paint, tmp_path / "a.3mf", "cura")] == [
        "colours-lost"
    ]
    assert colour_findings(result.paint, tmp_path / "a.3mf", "orca") == ()
    assert not at_or_above(colour_findings(None, tmp_path / "a.stl"), "info")


def test_orca_gets_the_paint_under_its_own_names(model: Path, tmp_path: Path) -> None:
    path = tmp_path / "out.3mf"
    run_job(Job(model, path, options=QUICK, written_for="orca"))
    found = read_3mf(path)
    assert found.paint is not None
    assert any(("colour", "8") in style.strokes for style in found.paint.styles)
    with zipfile.ZipFile(path) as archive:
        text = archive.read("3D/3dmodel.model")
    assert b'paint_color="8"' in text
    assert b"mmu_segmentation" not in text


@pytest.mark.slicer
def test_the_slicer_itself_keeps_the_paint(prusa_slicer: Path, model: Path, tmp_path: Path) -> None:
    """PrusaSlicer reads the part, and writes the same painted area in a file of its own."""
    part, theirs = tmp_path / "part.3mf", tmp_path / "theirs.3mf"
    run_job(Job(model, part, options=QUICK))
    command = [str(prusa_slicer), "--dont-arrange", "--export-3mf", "-o", str(theirs), str(part)]
    subprocess.run(command, check=True, capture_output=True, timeout=60)
    areas_of = []
    for path in (part, theirs):
        found = read_3mf(path)
        assert found.paint is not None
        by_style = area_by_style(found.paint, found.vertices, found.faces)
        areas_of.append(sum(area for style, area in by_style.items() if style.strokes))
    assert areas_of[1] == pytest.approx(areas_of[0], rel=1e-4)
