"""A batch on a real scheduler with real workers: parts as of a single run, whatever dies."""

from __future__ import annotations

import json
import sys
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest
from batch_workers import QUICK, models
from dask_cluster import Cluster, cluster

from printprep.batches.cluster import connect
from printprep.batches.item import found_models, items_of
from printprep.batches.journal import rows_in
from printprep.batches.row import Row
from printprep.batches.run import BatchOptions, batch, plan, run_batch
from printprep.cli.run import run
from printprep.errors import ToolError

pytestmark = [
    pytest.mark.slow,
    pytest.mark.xdist_group("dask"),
    pytest.mark.filterwarnings("ignore"),
    pytest.mark.skipif(sys.platform == "win32", reason="process groups are POSIX's"),
]


@pytest.fixture(scope="module")
def two_workers(tmp_path_factory):
    with cluster(tmp_path_factory.mktemp("dask")) as found:
        yield found


def parts(folder: Path) -> dict[str, bytes]:
    return {
        path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*.3mf")
    }


def alike(rows: list[Row]) -> set[str]:
    """Rows without what a machine's mood decides."""
    return {str(replace(row, seconds=None, peak_mib=None)) for row in rows}


@pytest.mark.parametrize("transfer", [False, True])
def test_parts_are_those_of_this_machine(two_workers: Cluster, tmp_path, transfer):
    models(tmp_path / "in", "a.stl", "b/c.stl")
    (tmp_path / "in" / "bad.stl").write_text("hello")
    here = list(
        batch([tmp_path / "in"], QUICK, output=tmp_path / "here", run=BatchOptions(workers=1))
    )
    with connect(two_workers.address) as client:
        how = BatchOptions(transfer=transfer)
        there = list(
            batch([tmp_path / "in"], QUICK, output=tmp_path / "there", client=client, run=how)
        )
    assert parts(tmp_path / "there") == parts(tmp_path / "here") != {}
    assert alike(there) == alike(here)


def test_a_time_limit_holds_there_too(two_workers: Cluster, tmp_path):
    models(tmp_path / "in", "a.stl")
    with connect(two_workers.address) as client:
        how = BatchOptions(timeout_s=0.2)
        (row,) = batch([tmp_path / "in"], QUICK, output=tmp_path / "out", client=client, run=how)
    assert row.status == "timeout"
    assert not parts(tmp_path / "out")


def test_a_worker_that_dies_loses_nothing(tmp_path):
    names = [f"m{number}.stl" for number in range(8)]
    models(tmp_path / "in", *names)
    with cluster(tmp_path / "dask") as found, connect(found.address) as client:
        killer = threading.Timer(4.0, found.kill_worker)
        killer.start()
        rows = list(batch([tmp_path / "in"], QUICK, output=tmp_path / "out", client=client))
        killer.join()
    assert sorted(row.output for row in rows) == sorted(f"m{n}.3mf" for n in range(8))
    assert {row.status for row in rows} == {"part"}
    assert len(parts(tmp_path / "out")) == 8
    lines = (tmp_path / "out" / "journal.jsonl").read_text().splitlines()
    assert sorted(json.loads(line)["output"] for line in lines) == sorted(
        row.output for row in rows
    )


def test_workers_of_another_version_are_refused(two_workers: Cluster, tmp_path, monkeypatch):
    monkeypatch.setattr("printprep.batches.cluster.__version__", "9.9")
    models(tmp_path, "a.stl")
    with connect(two_workers.address) as client, pytest.raises(ToolError, match=r"9\.9"):
        list(batch([tmp_path / "a.stl"], QUICK, output=tmp_path / "out", client=client))


def test_a_scheduler_without_workers_is_refused(tmp_path):
    models(tmp_path, "a.stl")
    with (
        cluster(tmp_path / "dask", workers=0) as found,
        connect(found.address) as client,
        pytest.raises(ToolError, match="no worker"),
    ):
        list(batch([tmp_path / "a.stl"], QUICK, output=tmp_path / "out", client=client))


def test_the_command_reaches_the_scheduler(two_workers: Cluster, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    models(tmp_path, "in/a.stl")
    line = ["batch", "in", "-o", "out", "--scheduler", two_workers.address, "--resolution", "16"]
    assert run(line) == 0
    assert "1 model: 1 part" in capsys.readouterr().out
    start = time.monotonic()
    assert run([*line, "--resume"]) == 0
    assert "complete and unchanged" in capsys.readouterr().out
    assert time.monotonic() - start < 30


def test_the_options_of_a_job_travel(two_workers: Cluster, tmp_path):
    models(tmp_path / "in", "a.stl")
    job = replace(QUICK, overrides={"wall_mm": 2.0})
    with connect(two_workers.address) as client:
        (row,) = batch([tmp_path / "in"], job, output=tmp_path / "out", client=client)
    assert row.wall_min_mm == pytest.approx(2.0, abs=0.05)


def test_a_scheduler_that_is_lost_ends_the_batch_with_what_to_do(tmp_path):
    models(tmp_path / "in", *(f"m{number}.stl" for number in range(6)))
    out = tmp_path / "out"
    with cluster(tmp_path / "dask", workers=1) as found, connect(found.address) as client:
        rows = batch([tmp_path / "in"], QUICK, output=out, client=client)
        next(rows)
        found.kill_scheduler()
        with pytest.raises(ToolError, match="scheduler was lost") as caught:
            list(rows)
    assert "--resume" in (caught.value.hint or "")
    assert 1 <= len(rows_in(out)) < 6
    again = BatchOptions(workers=1, resume=True)
    assert len(list(batch([tmp_path / "in"], QUICK, output=out, run=again))) == 6


def test_a_model_that_vanishes_is_its_row(two_workers: Cluster, tmp_path):
    a, b = models(tmp_path / "in", "a.stl", "b.stl")
    items = items_of(found_models([a, b]), QUICK, tmp_path / "out")
    planned = plan(items, tmp_path / "out", resume=False)
    a.unlink()
    with connect(two_workers.address) as client:
        rows = {row.output: row for row in run_batch(planned, BatchOptions(transfer=True), client)}
    assert (rows["a.3mf"].status, rows["b.3mf"].status) == ("error", "part")
    assert "a.stl" in (rows["a.3mf"].message or "")


def test_a_model_that_kills_every_worker_is_a_crashed_row():
    """What the scheduler says of a task after as many deaths as it allows."""
    from distributed import Future, KilledWorker

    from printprep.batches.cluster import _told

    class Killed(Future):
        def __init__(self) -> None:
            pass

        def __del__(self) -> None:
            pass

        def result(self, timeout: float | None = None) -> None:
            raise KilledWorker("task", None, 2)

    told = _told(Killed())
    assert (told.status, told.facts["code"]) == ("crashed", "crashed")
