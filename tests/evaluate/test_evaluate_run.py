"""Results are kept, found again, and the same however they were computed."""

from __future__ import annotations

import json
from dataclasses import replace
from shutil import copytree

import pytest
from evaluate_models import write_boxes

from printprep.errors import InputError, OutputError, UsageError
from printprep.evaluate.cases import data_set
from printprep.evaluate.methods import ABLATIONS, MAIN, methods
from printprep.evaluate.run import evaluate

# One worker evaluates the two models for all of them
pytestmark = pytest.mark.xdist_group("evaluated models")
CUBE = ((0, 0, 0), (10, 10, 10))
GALLOWS = (((0, 0, 0), (3, 4, 12)), ((0, 0, 9), (10, 4, 12)))
QUICK = methods(["solid", "paper", "lean"], resolution=10)


@pytest.fixture
def models(tmp_path):
    folder = tmp_path / "models"
    folder.mkdir()
    write_boxes(folder / "cube.obj", CUBE)
    write_boxes(folder / "gallows.obj", *GALLOWS)
    return folder


@pytest.fixture(scope="module")
def evaluated(tmp_path_factory):
    """Where the two models have been evaluated once, and what came out."""
    folder = tmp_path_factory.mktemp("evaluated")
    write_boxes(folder / "cube.obj", CUBE)
    write_boxes(folder / "gallows.obj", *GALLOWS)
    return folder, evaluate(data_set(folder), QUICK, folder)


@pytest.fixture
def before(evaluated, tmp_path):
    """The same, with the results in ``tmp_path`` for a test to meddle with."""
    folder, found = evaluated
    copytree(folder / "results", tmp_path / "results")
    return found


def timeless(found):
    return [replace(row, seconds=0.0) for row in found.results]


def test_closed_forms_come_out(models, tmp_path):
    found = evaluate(data_set(models), QUICK, tmp_path / "out", voxels="centre")
    assert not found.failures
    rows = {(row.model, row.method): row for row in found.results}
    assert [(row.model, row.method) for row in found.results] == [
        (model, method) for model in ("cube", "gallows") for method in ("solid", "paper", "lean")
    ]
    solid = rows["cube", "solid"]
    assert (solid.mass, solid.mass_ratio, solid.tilt_deg) == (1.0, 1.0, pytest.approx(45.0))
    assert solid.stands and solid.f_score > 0.99
    lean = rows["cube", "lean"]  # the shell stands as it is
    assert lean.mass == pytest.approx(1 - (8 / 10) ** 3)
    assert lean.reachable_deg is None and lean.lean_deg == 10.0
    assert not rows["gallows", "solid"].stands
    assert rows["gallows", "solid"].tilt_deg < 0


def test_what_is_kept_is_not_computed_again(models, tmp_path, before):
    file = tmp_path / "results" / "cube" / "paper.json"
    stored = json.loads(file.read_text())
    stored["result"]["tilt_deg"] = 12.5
    file.write_text(json.dumps(stored))
    again = evaluate(data_set(models), QUICK, tmp_path)
    marked = {(row.model, row.method): row.tilt_deg for row in again.results}
    assert marked["cube", "paper"] == 12.5
    assert again.results[0] == before.results[0]  # to the seconds


@pytest.mark.parametrize("what", ["settings", "voxels", "model", "half a file", "missing"])
def test_what_does_not_fit_is_computed_again(models, tmp_path, before, what):
    file = tmp_path / "results" / "cube" / "paper.json"
    stored = json.loads(file.read_text())
    stored["result"]["tilt_deg"] = 12.5
    file.write_text(json.dumps(stored))
    chosen, voxels = QUICK, "surface"
    if what == "voxels":
        voxels = "centre"
    elif what == "settings":
        chosen = methods(["solid", "paper", "lean"], resolution=14)
    elif what == "model":
        write_boxes(models / "cube.obj", ((0, 0, 0), (20, 20, 20)))
    elif what == "half a file":
        file.write_text(file.read_text()[:100])
    else:
        file.unlink()
    after = evaluate(data_set(models), chosen, tmp_path, voxels=voxels)
    assert 12.5 not in [row.tilt_deg for row in after.results]
    if what not in ("settings", "voxels"):
        assert timeless(after) == timeless(before)


@pytest.mark.usefixtures("before")
def test_a_lean_of_no_concern_to_a_method_keeps_its_result(models, tmp_path):
    file = tmp_path / "results" / "cube" / "paper.json"
    stored = file.read_bytes()
    steeper = methods(["paper", "lean"], resolution=10, lean_deg=12.0)
    found = evaluate(data_set(models), steeper, tmp_path)
    assert file.read_bytes() == stored
    assert {row.lean_deg for row in found.results if row.method == "lean"} == {12.0}


@pytest.mark.slow
def test_workers_change_nothing(models, tmp_path, evaluated):
    told: list[tuple[str, int, int]] = []
    _, alone = evaluated
    together = evaluate(
        data_set(models), QUICK, tmp_path / "two", workers=2, told=lambda *a: told.append(a)
    )
    assert timeless(alone) == timeless(together)
    assert sorted(name for name, _, _ in told) == ["cube", "gallows"]
    assert [counts for _, *counts in told] == [[1, 2], [2, 2]]


def test_a_bad_model_does_not_stop_the_others(models, tmp_path):
    (models / "bad.stl").write_text("solid nothing")
    (models / "folder.ply").mkdir()
    found = evaluate(data_set(models), QUICK[:1], tmp_path)
    assert [row.model for row in found.results] == ["cube", "gallows"]
    assert [name for name, _ in found.failures] == ["bad", "folder"]
    for name, error in found.failures:
        assert isinstance(error, InputError) and f"{name}." in error.message


def test_a_folder_that_cannot_be_is_an_output_error(models, tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(OutputError, match="taken"):
        evaluate(data_set(models), QUICK[:1], tmp_path / "taken")
    with pytest.raises(UsageError, match="0 workers"):
        evaluate(data_set(models), QUICK[:1], tmp_path, workers=0)


def test_methods_by_name():
    names = [method.name for method in methods(["lean", "paper", "lean"], ablations=True)]
    assert names[:2] == ["lean", "paper"]
    assert sorted(names) == sorted({"lean", *ABLATIONS})
    assert len({json.dumps(m.described(), sort_keys=True) for m in methods(MAIN)}) == len(MAIN)
    ablations = methods((), ablations=True)
    assert len({json.dumps(m.described(), sort_keys=True) for m in ablations}) == len(ABLATIONS)
    wide = methods(["paper", "paper-wide-base", "lean"], base_reach="within")
    assert {method.settings.base_reach for method in wide} == {"within"}
    narrow = methods(["paper", "paper-wide-base"])
    assert [method.settings.base_reach for method in narrow] == ["below", "within"]
    assert "12.5° lean" in methods(["lean"], lean_deg=12.5)[0].title
    for options in ({"names": ["best"]}, {"names": []}, {"lean_deg": 90.0}):
        with pytest.raises(UsageError):
            methods(**options)
