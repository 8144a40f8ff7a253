"""Which models a batch has, where their parts go, and what makes a part another."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
from batch_workers import QUICK, models

from printprep.batches.item import found_models, item_of, items_of, key_of, refuse_clashes
from printprep.batches.run import with_profiles
from printprep.errors import InputError, UsageError
from printprep.profiles import load_profile


def outputs(inputs, folder: Path) -> list[str]:
    return [item.output for item in items_of(found_models(inputs), QUICK, folder)]


def test_a_folder_keeps_its_structure(tmp_path):
    models(tmp_path / "in", "b.stl", "a/b.stl", "a/c.STL")
    (tmp_path / "in" / "notes.txt").write_text("no model")
    assert outputs([tmp_path / "in"], tmp_path / "out") == ["a/b.3mf", "a/c.3mf", "b.3mf"]


def test_files_and_patterns_are_named_by_the_file(tmp_path):
    models(tmp_path, "x/a.stl", "x/b.stl", "y/c.stl")
    inputs = [tmp_path / "y" / "c.stl", str(tmp_path / "x" / "*.stl")]
    assert outputs(inputs, tmp_path) == ["c.3mf", "a.3mf", "b.3mf"]


def test_what_is_missing_is_told_with_its_name(tmp_path):
    (tmp_path / "empty").mkdir()
    for given, words in (
        (tmp_path / "none.stl", "does not exist"),
        (tmp_path / "*.obj", "matches no file"),
        (tmp_path / "empty", "holds no model"),
    ):
        with pytest.raises(InputError, match=words) as caught:
            outputs([given], tmp_path)
        assert given.name in caught.value.message


@pytest.mark.parametrize("names", [("a/m.stl", "b/m.stl"), ("a/m.stl", "b/M.stl")])
def test_two_parts_of_one_name_are_refused(tmp_path, names):
    paths = models(tmp_path, *names)
    items = items_of(found_models(paths), QUICK, tmp_path / "out")
    with pytest.raises(UsageError, match="both be written") as caught:
        refuse_clashes(items)
    assert all(str(path) in caught.value.message for path in paths)
    refuse_clashes(items_of(found_models([tmp_path]), QUICK, tmp_path / "out"))


def test_the_key_changes_with_all_that_the_part_depends_on(tmp_path, monkeypatch):
    (path,) = models(tmp_path, "m.stl")
    item = item_of(replace(QUICK, model=path), "m", Path("m.stl"), tmp_path / "out")
    elsewhere = item_of(replace(QUICK, model=path), "other", Path("x/m.stl"), tmp_path / "away")
    assert key_of(item.job) == key_of(elsewhere.job) != ""
    wall = replace(item, job=replace(item.job, overrides={"wall_mm": 2.0}))
    lean = replace(item, job=replace(item.job, options=replace(item.job.options, lean="15")))
    resin = replace(item, job=replace(item.job, profile="resin-standard"))
    keys = {key_of(each.job) for each in (item, wall, lean, resin)}
    monkeypatch.setattr("printprep.batches.item.__version__", "9.9")
    keys.add(key_of(item.job))
    path.write_bytes(path.read_bytes() + b" ")
    keys.add(key_of(item.job))
    assert len(keys) == 6
    path.unlink()
    assert key_of(item.job) == ""


def test_parts_that_lie_among_the_models_are_no_models(tmp_path):
    models(tmp_path, "a.stl", "out/a.stl")
    found = found_models([tmp_path], tmp_path / "out")
    assert [place.as_posix() for _, _, place in found] == ["a.stl"]


def test_a_loaded_profile_travels_with_the_job_and_changes_nothing(tmp_path):
    models(tmp_path, "a.stl")
    job = replace(QUICK, overrides={"wall_mm": 2.0})
    (item,) = items_of(found_models([tmp_path]), job, tmp_path / "out")
    (loaded,) = with_profiles([item])
    assert loaded.job.profile == load_profile("fdm-pla-0.4", {"wall_mm": 2.0})
    assert key_of(loaded.job) == key_of(item.job)
