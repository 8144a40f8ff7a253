"""Rows on disk, and a batch that goes on where it was killed."""

from __future__ import annotations

from dataclasses import replace

import pytest
from batch_workers import QUICK, models

from printprep.batches.item import found_models, items_of
from printprep.batches.journal import NAME, Journal, rows_in
from printprep.batches.row import Row
from printprep.batches.run import BatchOptions, batch, plan
from printprep.errors import InputError, UsageError

ROW = Row("a.stl", "a.3mf", "part", "k", mass_g=1.5, findings={"info": 2}, rules=("tilt",))
ONE = BatchOptions(workers=1)


def test_rows_are_read_back_the_last_of_each_output_counting(tmp_path):
    with Journal(tmp_path) as journal:
        journal.append(ROW)
        journal.append(replace(ROW, name="b.stl", output="b.3mf", status="crashed"))
        journal.append(replace(ROW, mass_g=2.5))
    rows = rows_in(tmp_path)
    assert rows["a.3mf"] == replace(ROW, mass_g=2.5)
    assert rows["b.3mf"].status == "crashed"


@pytest.mark.parametrize("torn", [b'{"name": "b.s', b"\x00\x00\n", b"[]\n", b'{"name": 3}\n'])
def test_a_torn_line_is_no_row_and_the_next_one_is_whole(tmp_path, torn):
    with Journal(tmp_path) as journal:
        journal.append(ROW)
    with (tmp_path / NAME).open("ab") as file:
        file.write(torn)
    with Journal(tmp_path) as journal:
        journal.append(replace(ROW, output="c.3mf"))
    assert set(rows_in(tmp_path)) == {"a.3mf", "c.3mf"}


def test_a_batch_and_its_resumption(tmp_path):
    models(tmp_path / "in", "a.stl", "b/c.stl")
    (tmp_path / "in" / "bad.stl").write_text("hello")
    out = tmp_path / "out"
    rows = {row.output: row for row in batch([tmp_path / "in"], QUICK, output=out, run=ONE)}
    assert {name: row.status for name, row in rows.items()} == {
        "a.3mf": "part", "b/c.3mf": "part", "bad.3mf": "error",
    }  # fmt: skip
    assert rows["bad.3mf"].code == "input" and not (out / "bad.3mf").exists()
    written = {path: path.read_bytes() for path in out.rglob("*.3mf")}
    stamps = {path: path.stat().st_mtime_ns for path in written}

    with pytest.raises(UsageError, match="earlier batch"):
        list(batch([tmp_path / "in"], QUICK, output=out, run=ONE))
    again = replace(ONE, resume=True)
    assert {r.output: r for r in batch([tmp_path / "in"], QUICK, output=out, run=again)} == rows
    assert {path: path.stat().st_mtime_ns for path in written} == stamps

    # Only what was touched, lost or changed is done again
    (out / "a.3mf").write_bytes(b"touched")
    models(tmp_path / "in", "new.stl")
    items = items_of(found_models([tmp_path / "in"]), QUICK, out)
    left = plan(items, out, resume=True).left
    assert [item.output for item in left] == ["a.3mf", "new.3mf"]
    list(batch([tmp_path / "in"], QUICK, output=out, run=again))
    assert {path: path.read_bytes() for path in written} == written
    other = replace(QUICK, overrides={"wall_mm": 2.0})
    items = items_of(found_models([tmp_path / "in"]), other, out)
    assert len(plan(items, out, resume=True).left) == 4


def test_what_crashed_is_tried_again(tmp_path):
    models(tmp_path, "a.stl")
    (item,) = items_of(found_models([tmp_path / "a.stl"]), QUICK, tmp_path / "out")
    (tmp_path / "out").mkdir()
    from printprep.batches.item import key_of

    for status, left in (("crashed", 1), ("timeout", 1), ("memory", 1), ("stopped", 0)):
        with Journal(tmp_path / "out") as journal:
            journal.append(Row("a", item.output, status, key_of(item.job)))
        assert len(plan([item], tmp_path / "out", resume=True).left) == left


def test_nothing_starts_where_something_cannot_be(tmp_path):
    (path,) = models(tmp_path, "a.stl")
    out = tmp_path / "out"
    with pytest.raises(InputError, match="does not exist"):
        list(batch([path, tmp_path / "none.stl"], QUICK, output=out))
    with pytest.raises(UsageError, match=r"a\.stl.*wall_mm"):
        list(batch([path], replace(QUICK, overrides={"wall_mm": -1}), output=out))
    assert not out.exists()


def test_a_part_of_a_batch_is_that_of_a_single_run(tmp_path):
    from printprep.pipeline.job import run_job

    (path,) = models(tmp_path, "a.stl")
    run_job(replace(QUICK, model=path, output=tmp_path / "single.3mf"))
    (row,) = batch([path], QUICK, output=tmp_path / "out", run=ONE)
    part = (tmp_path / "out" / "a.3mf").read_bytes()
    assert part == (tmp_path / "single.3mf").read_bytes()
    assert row.mass_g is not None and row.seconds is not None
    assert row.rules == ("unsupported-ceiling",)
