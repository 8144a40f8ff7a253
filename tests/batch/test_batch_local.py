"""The pool: whatever a worker does is one model's row."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest
from batch_workers import QUICK, by_name, models

from printprep.batches.item import Item
from printprep.batches.journal import NAME, rows_in
from printprep.batches.local import run_locally
from printprep.batches.memory import estimated_mib

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="SIGKILL is POSIX's")


def items(*names: str) -> list[Item]:
    return [Item(name, replace(QUICK, model=Path(f"{name}.stl")), f"{name}.3mf") for name in names]


def test_death_hanging_and_hunger_are_rows_and_the_rest_goes_on():
    wanted = items("a", "dies", "b", "hangs", "full", "c")
    ended = list(run_locally(wanted, workers=2, timeout_s=5.0, run=by_name))
    statuses = {item.name: told.status for item, told in ended}
    assert len(ended) == 6
    assert statuses == {
        "a": "part", "b": "part", "c": "part",
        "dies": "crashed", "hangs": "timeout", "full": "memory",
    }  # fmt: skip
    facts = {item.name: told.facts for item, told in ended}
    assert "signal 9" in facts["dies"]["message"] and "5 s" in facts["hangs"]["message"]


def test_a_job_larger_than_the_memory_runs_alone(tmp_path):
    big = tmp_path / "big.stl"
    with big.open("wb") as file:
        file.truncate(50_000_000)  # a million triangles, by its size
    one = Item("big", replace(QUICK, model=big), "big.3mf")
    small = items("a")[0]
    assert estimated_mib(one.job) > estimated_mib(small.job) + 1000
    assert len(list(run_locally([one, small], workers=2, memory_mib=100.0, run=by_name))) == 2


def test_nothing_to_do_is_done_at_once():
    assert list(run_locally([], run=by_name)) == []


def batch_process(folder: Path, *more: str) -> subprocess.Popen[bytes]:
    words = ["-m", "printprep", "batch", "in", "-o", "out", "--resolution", "16", "--jobs", "2"]
    return subprocess.Popen(
        [sys.executable, *words, *more],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        start_new_session=True,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )


def wait_for_rows(folder: Path, count: int) -> None:
    journal = folder / "out" / NAME
    end = time.monotonic() + 60
    while not journal.exists() or len(journal.read_bytes().splitlines()) < count:
        assert time.monotonic() < end
        time.sleep(0.05)


@pytest.mark.slow
@pytest.mark.parametrize("end", [signal.SIGKILL, signal.SIGINT], ids=["killed", "interrupted"])
def test_a_batch_that_ends_midway_goes_on_where_it_was(tmp_path, end):
    models(tmp_path / "in", *(f"m{number}.stl" for number in range(6)))
    first = batch_process(tmp_path)
    wait_for_rows(tmp_path, 2)
    os.kill(first.pid, end)
    _, err = first.communicate(timeout=20)
    if end == signal.SIGINT:
        assert first.returncode == 130 and b"Traceback" not in err
    os.killpg(first.pid, signal.SIGKILL) if end == signal.SIGKILL else None
    before = rows_in(tmp_path / "out")
    assert 2 <= len(before) < 6
    stamps = {name: (tmp_path / "out" / name).stat().st_mtime_ns for name in before}

    second = batch_process(tmp_path, "--resume")
    _, err = second.communicate(timeout=120)
    assert second.returncode == 0, err
    after = rows_in(tmp_path / "out")
    assert sorted(after) == [f"m{number}.3mf" for number in range(6)]
    assert {row.status for row in after.values()} == {"part"}
    assert stamps == {name: (tmp_path / "out" / name).stat().st_mtime_ns for name in before}
    lines = (tmp_path / "out" / NAME).read_bytes().splitlines()
    assert len(lines) == 6
    assert not [path for path in (tmp_path / "out").iterdir() if path.suffix == ".part"]


@pytest.mark.slow
@pytest.mark.parametrize(("name", "resolution"), [("bottle.stl", 16), ("spot.stl", 96)])
def test_the_estimate_lies_above_what_a_job_takes(samples_dir, tmp_path, name, resolution):
    options = replace(QUICK.options, resolution=resolution)
    job = replace(QUICK, model=samples_dir / name, output=tmp_path / "out.3mf", options=options)
    ((_, told),) = run_locally([Item(name, job, "out.3mf")], workers=1)
    assert told.status == "part"
    if told.facts["peak_mib"] is not None:
        assert told.facts["peak_mib"] <= estimated_mib(job)
