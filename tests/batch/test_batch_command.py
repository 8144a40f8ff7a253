"""The command: tables, rows as they end, the summary, and what the exit code says."""

from __future__ import annotations

import csv
import json
from pathlib import Path

import pytest
from batch_workers import models

from printprep.batches.item import Item
from printprep.cli.batch_table import items_in
from printprep.cli.run import run
from printprep.errors import InputError, UsageError
from printprep.pipeline.options import FillOptions

FAST = ["--resolution", "16", "--no-self-support", "--jobs", "1"]
GIVEN = {"resolution": 16, "lean": "12"}


def table(tmp_path: Path, text: str) -> list[Item]:
    path = tmp_path / "orders.csv"
    path.write_text(text, encoding="utf-8")
    return items_in(path, GIVEN, tmp_path / "out", ".3mf", "none")


def test_any_option_is_a_column_and_an_empty_cell_leaves_the_batchs(tmp_path):
    models(tmp_path, "a.stl", "x/b.stl")
    one, two = table(
        tmp_path,
        "\ufefffile,lean,--wall,no-drains,set,vaults,profile\n"
        "a.stl,15@90,2,,material.name=PC; printer.layer_height_mm=0.15,none,\n"
        "x/b.stl,,,yes,,printer,\n",
    )
    assert one.job.options == FillOptions(resolution=16, lean="15@90", vaults="none")
    assert one.job.overrides == {
        "wall_mm": 2.0, "material.name": "PC", "printer.layer_height_mm": "0.15",
    }  # fmt: skip
    assert two.job.options == FillOptions(resolution=16, lean="12", vaults="printer")
    assert two.job.overrides == {"drain.count": 0}
    assert [item.output for item in (one, two)] == ["a.3mf", "x/b.3mf"]
    assert two.job.model == tmp_path / "x" / "b.stl"


def test_a_column_names_the_part_so_that_one_model_can_be_there_twice(tmp_path):
    models(tmp_path, "a.stl")
    items = table(tmp_path, "file,size,output\na.stl,30,small/a\na.stl,60,big/a.3mf\na.stl,90,\n")
    assert [item.output for item in items] == ["small/a.3mf", "big/a.3mf", "a.3mf"]
    assert [item.job.placement.size_mm for item in items] == [30, 60, 90]


@pytest.mark.parametrize(
    ("text", "error", "words"),
    [
        ("model\na.stl\n", UsageError, "no column file"),
        ("file,wal\na.stl,2\n", UsageError, "wal is not an option"),
        ("file,lean,lean\na.stl,1,2\n", UsageError, "twice"),
        ("file\nnone.stl\n", UsageError, "line 2: the file none.stl does not exist"),
        ("file,lean\na.stl,steep\n", UsageError, "line 2: .*steep"),
        ("file,wall\na.stl,-1\n", UsageError, "line 2: .*wall_mm"),
        ("file,base\na.stl,maybe\n", UsageError, "line 2: .*maybe"),
        ("file,verify\na.stl,perhaps\n", UsageError, "neither yes nor no"),
        ("file,output\na.stl,../b\n", UsageError, "not below the folder"),
        ("file,output\na.stl,/b\n", UsageError, "not below the folder"),
        ("file,height,size\na.stl,5,6\n", None, ""),
        ("file\na.stl,extra\n", UsageError, "more cells than columns"),
        ("file\n\n,\n", UsageError, "more cells"),
    ],
)
def test_what_cannot_be_is_told_by_its_line(tmp_path, text, error, words):
    models(tmp_path, "a.stl")
    if error is None:  # two sizes exclude each other when the model is placed: that is its row
        assert len(table(tmp_path, text)) == 1
        return
    with pytest.raises(error, match=words):
        table(tmp_path, text)


def test_every_wrong_line_is_in_one_message(tmp_path):
    models(tmp_path, "a.stl")
    with pytest.raises(UsageError) as caught:
        table(tmp_path, "file,lean\nnone.stl,\na.stl,\na.stl,99\n")
    assert "line 2" in caught.value.message and "line 4" in caught.value.message
    assert "line 3" not in caught.value.message


def test_a_table_that_is_no_text_is_an_input_error(tmp_path):
    path = tmp_path / "orders.csv"
    path.write_bytes(b"file\n\xff\xfe\x00")
    with pytest.raises(InputError, match=r"orders\.csv"):
        items_in(path, GIVEN, tmp_path, ".3mf", "none")


def test_names_that_no_file_has_are_told_by_their_line(tmp_path):
    path = tmp_path / "orders.csv"
    path.write_bytes(b"file\na\0b\0c.stl\n")
    with pytest.raises(InputError, match="line 2: a cell holds a zero character"):
        items_in(path, GIVEN, tmp_path, ".3mf", "none")
    path.write_text(f"file\n{'n' * 5000}.stl\n")
    with pytest.raises(UsageError, match="does not exist") as caught:
        items_in(path, GIVEN, tmp_path, ".3mf", "none")
    assert len(caught.value.message) < 600
    path.write_text('file,"si\nze"\na.stl,5\n')
    with pytest.raises(UsageError, match="si ze is not an option"):
        items_in(path, GIVEN, tmp_path, ".3mf", "none")
    device = tmp_path / "zero.csv"
    device.symlink_to("/dev/zero")
    with pytest.raises(InputError, match="is not a plain file"):
        items_in(device, GIVEN, tmp_path, ".3mf", "none")


def test_a_table_names_plate_and_object_of_each_model(tmp_path):
    from manifold3d import Manifold

    from printprep.mesh.measure import arrays
    from printprep.threemf.write import Item, Volume, write_3mf

    cube = Volume("v", *arrays(Manifold.cube((9, 9, 9))))
    (tmp_path / "two.3mf").write_bytes(write_3mf([Item("a", [cube]), Item("b", [cube])]))
    path = tmp_path / "orders.csv"
    path.write_text("file,object,plate,partial\ntwo.3mf,b,,yes\n")
    (item,) = items_in(path, GIVEN, tmp_path, ".3mf", "none")
    placement = item.job.placement
    assert (placement.item, placement.plate, placement.partial) == ("b", None, True)


def test_the_command_from_folder_and_table_to_summary(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    models(tmp_path, "in/a.stl", "orders/b.stl")
    Path("in/bad.stl").write_text("hello")
    Path("orders/t.csv").write_text("file,wall\nb.stl,2\n")
    assert run(["batch", "in", "orders/t.csv", "-o", "out", "--json", *FAST]) == 1
    rows = {row["output"]: row for row in map(json.loads, capsys.readouterr().out.splitlines())}
    assert {name: row["status"] for name, row in rows.items()} == {
        "a.3mf": "part", "bad.3mf": "error", "b.3mf": "part",
    }  # fmt: skip
    assert rows["b.3mf"]["wall_min_mm"] == pytest.approx(2.0, abs=0.05)
    assert rows["bad.3mf"]["code"] == "input"
    summary = json.loads(Path("out/summary.json").read_text())
    assert summary["counts"] == {"part": 2, "error": 1}
    assert [row["output"] for row in summary["rows"]] == ["a.3mf", "bad.3mf", "b.3mf"]
    with Path("out/summary.csv").open(newline="") as file:
        lines = list(csv.DictReader(file))
    assert [line["status"] for line in lines] == ["part", "error", "part"]
    assert float(lines[0]["mass_g"]) == rows["a.3mf"]["mass_g"]

    Path("in/bad.stl").unlink()
    assert run(["batch", "in", "-o", "out", "--resume", *FAST]) == 0
    out = capsys.readouterr().out
    assert "1 model complete and unchanged: skipped" in out and "1 model: 1 part" in out


def test_a_part_that_reaches_fail_on_is_a_row_and_not_a_file(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    models(tmp_path, "a.stl")
    assert run(["batch", "a.stl", "-o", "out", "--fail-on", "warning", *FAST]) == 1
    assert "unsupported-ceiling reached the --fail-on level" in capsys.readouterr().out
    assert not Path("out/a.3mf").exists()


def test_plugs_are_written_beside_each_part(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    models(tmp_path, "a.stl", size=25.0)
    line = ["batch", "a.stl", "-o", "out", "-p", "resin-standard", "--resolution", "16"]
    assert run([*line, "--jobs", "1", "--plugs"]) == 0
    assert Path("out/a.3mf").is_file() and Path("out/a-plugs.3mf").is_file()
    assert run([*line, "--plugs", "--transfer", "--resume"]) == 2
    assert "not plugs" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("line", "code", "words"),
    [
        ("batch", 2, "Missing argument"),
        ("batch a.stl", 2, "--output"),
        ("batch none.stl -o out", 3, "does not exist"),
        ("batch a.stl a.stl -o out", 2, "both be written"),
        ("batch a.stl -o out --wall -3", 2, "wall_mm"),
        ("batch a.stl -o out --format stl --fill infill", 2, "cannot carry infill"),
        ("batch a.stl -o out --jobs 0", 2, "--jobs"),
        ("batch a.stl -o out --plugs", 2, "no effect"),
        ("batch a.stl -o a.stl", 5, "folder"),
        ("batch a.stl -o out --scheduler tcp://127.0.0.1:9", 6, "No scheduler answers"),
    ],
)
def test_what_cannot_be_is_told_before_anything_runs(
    tmp_path, capsys, monkeypatch, line, code, words
):
    monkeypatch.chdir(tmp_path)
    models(tmp_path, "a.stl")
    assert run(line.split()) == code
    assert words in capsys.readouterr().err
    assert not Path("out").exists()
