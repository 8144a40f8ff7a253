"""Folders and catalogues, and what is wrong with them."""

from __future__ import annotations

import pytest

from printprep.errors import InputError, UsageError
from printprep.evaluate.cases import data_set


def test_a_folder_gives_its_meshes_in_order(tmp_path):
    for name in ("b.stl", "a.OBJ", "notes.txt", "a.ply"):
        (tmp_path / name).write_text("")
    found = data_set(tmp_path, up="-y")
    assert found.label == tmp_path.name
    assert [case.name for case in found.cases] == ["a.OBJ", "a.ply", "b"]
    assert {case.up for case in found.cases} == {"-y"}


def test_a_catalogue_says_where_and_what_is_up(tmp_path):
    path = tmp_path / "list.csv"
    path.write_text("set,file,up\ndev,a.obj,+y\nother,b.obj,+x\ndev,c.obj,\n")
    found = data_set(path, subset="dev", up="+z")
    assert found.label == "list, set dev"
    assert [(case.name, case.up) for case in found.cases] == [("a", "+y"), ("c", "+z")]
    assert found.cases[0].path == tmp_path / "dev" / "a.obj"
    assert [case.name for case in data_set(path, limit=2).cases] == ["a", "b"]
    assert [case.name for case in data_set(path, only=["b"]).cases] == ["b"]


def test_a_catalogue_without_sets_names_files_beside_it(tmp_path):
    path = tmp_path / "list.csv"
    path.write_text("file\na.obj\n")
    assert data_set(path).cases[0].path == tmp_path / "a.obj"


@pytest.mark.parametrize(
    "text, options, error, says",
    [
        ("file,up\na.obj,up\n", {}, UsageError, "is not an axis"),
        ("name\na.obj\n", {}, InputError, "line 2 has no file"),
        ("file\n", {}, InputError, "holds no model"),
        ("set,file\ndev,a.obj\n", {"subset": "test"}, InputError, "of the set test"),
        ("file\na.obj\n", {"only": ["b"]}, UsageError, "--only b"),
        ("file\na.obj\n", {"limit": 0}, UsageError, "--limit 0"),
    ],
)
def test_an_invalid_catalogue(tmp_path, text, options, error, says):
    path = tmp_path / "list.csv"
    path.write_text(text)
    with pytest.raises(error, match=says):
        data_set(path, **options)


def test_what_is_not_there_or_no_text(tmp_path):
    with pytest.raises(InputError, match="does not exist"):
        data_set(tmp_path / "list.csv")
    (tmp_path / "list.csv").write_bytes(b"file\n\xff\xfe\xfa\n")
    with pytest.raises(InputError, match="cannot be read as CSV"):
        data_set(tmp_path / "list.csv")
    with pytest.raises(UsageError, match="is a folder"):
        data_set(tmp_path, subset="dev")
