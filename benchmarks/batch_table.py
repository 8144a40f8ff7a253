"""Batches on this machine and on a real Dask scheduler, measured: what is lost, what it costs.

    python benchmarks/batch_table.py models ../shared/models/catalogue.csv -w /tmp/batches
    python benchmarks/batch_table.py rate ../shared/models/catalogue.csv -w /tmp/batches
    python benchmarks/batch_table.py tiny -w /tmp/batches

``models`` runs the dev set in several sizes and leans, ten bad files among them: one at a time,
then on a scheduler with two worker processes of which one is killed midway, then once more with
--resume; it compares every part with the one made alone.  ``rate`` compares models a minute.
``tiny`` runs many cubes and shows what a job costs beside the work, and that it does not grow with
their number.
"""

from __future__ import annotations

import argparse
import itertools
import os
import sys
import time
from collections import Counter
from dataclasses import replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests" / "batch"))
sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from dask_cluster import cluster
from rows import catalogue

from printprep.batches.cluster import connect
from printprep.batches.item import Item, item_of, sha256_of
from printprep.batches.row import Row
from printprep.batches.run import BatchOptions, plan, run_batch
from printprep.mesh.write import to_bytes
from printprep.pipeline.job import Job
from printprep.pipeline.options import FillOptions, Placement
from printprep.processors import bind

BAD = (
    b"", b"hello", b"solid x\nfacet", b"\x00" * 84, b"\xff" * 200, b"PK\x03\x04",
    b"solid x\nendsolid x\n", b"0" * 83, b"\x00" * 80 + b"\xff\xff\xff\xff", b"solid\n" * 9,
)  # fmt: skip


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("what", choices=("models", "rate", "tiny"))
    parser.add_argument("catalogue", type=Path, nargs="?", help="of the models")
    parser.add_argument("-w", "--work", type=Path, required=True, help="a folder of its own")
    parser.add_argument("--count", type=int, help="models, or cubes")
    parser.add_argument("--resolution", type=int, default=32)
    arguments = parser.parse_args()
    arguments.work.mkdir(parents=True, exist_ok=True)
    if arguments.what == "tiny":
        return tiny(arguments.work, arguments.count or 2000)
    if arguments.what == "rate":
        return rate(
            arguments.catalogue, arguments.work, arguments.count or 50, arguments.resolution
        )
    return models(arguments.catalogue, arguments.work, arguments.count or 200, arguments.resolution)


def models(table: Path, work: Path, count: int, resolution: int) -> int:
    """Many models on a cluster that loses a worker, against the same one at a time."""
    alone, there = work / "alone", work / "there"
    items = items_for(table, work, count, resolution)
    one_s, rows = timed(items, alone, BatchOptions(workers=1))
    print(f"one at a time: {one_s:.0f} s, {dict(Counter(row.status for row in rows))}")
    moved = [replace(i, job=replace(i.job, output=there / i.output)) for i in items]
    with cluster(work / "dask") as found, connect(found.address) as client:
        start = time.perf_counter()
        ended = []
        for row in run_batch(plan(moved, there, resume=False), BatchOptions(), client):
            ended.append(row)
            if len(ended) == count // 4:
                found.kill_worker(restarts=True)
        print(f"two workers, one killed after {count // 4}: {time.perf_counter() - start:.0f} s")
        outputs = Counter(row.output for row in ended)
        twice, lost = sum(n > 1 for n in outputs.values()), len(items) - len(outputs)
        statuses = dict(Counter(row.status for row in ended))
        print(f"rows {len(ended)}, twice {twice}, lost {lost}, {statuses}")
        again = plan(moved, there, resume=True)
        print(f"--resume leaves {len(again.left)} to do")
    same = sum(sha256_of(alone / r.output) == sha256_of(there / r.output) for r in parts(ended))
    print(f"parts the same to the byte: {same} of {len(parts(rows))}")
    print(f"peak memory of a job: {max(row.peak_mib or 0 for row in ended):.0f} MiB")
    return 1 if lost or twice or again.left or same != len(parts(rows)) else 0


def rate(table: Path, work: Path, count: int, resolution: int) -> int:
    """Models a minute: one at a time on one core and on all, two workers here and on Dask."""
    items = items_for(table, work, count, resolution)
    cores = os.cpu_count() or 1
    ways = (("one core", 1, False), ("all cores", 1, False), ("two local", 2, False),
            ("two on Dask", 2, True))  # fmt: skip
    print("| one at a time, or two workers | s | models a minute | the jobs' own seconds |")
    print("|---|---|---|---|")
    with cluster(work / "dask") as found, connect(found.address) as client:
        client.run(_warm)
        for name, workers, there in ways:
            folder = work / name.replace(" ", "-")
            mine = [replace(i, job=replace(i.job, output=folder / i.output)) for i in items]
            if name == "one core":
                bind(0, cores)
            how = BatchOptions(workers=workers)
            seconds, done = timed(mine, folder, how, client if there else None)
            if name == "one core":
                for task in Path("/proc/self/task").iterdir():
                    os.sched_setaffinity(int(task.name), range(cores))
            busy = sum(row.seconds or 0 for row in done)
            print(f"| {name} | {seconds:.1f} | {60 * len(items) / seconds:.1f} | {busy:.1f} |")
    return 0


def _warm() -> None:
    """Import in a worker what its first job would."""
    import printprep.pipeline.hollow
    import printprep.supports  # noqa: F401


def tiny(work: Path, count: int) -> int:
    """What a job costs beside its work, for more and more cubes."""
    from solids import box

    folder = work / "cubes"
    folder.mkdir(exist_ok=True)
    for number in range(count):
        path = folder / f"c{number}.stl"
        if not path.exists():
            path.write_bytes(to_bytes(box(2 + number % 7 / 10, 2, 2), ".stl"))
    job = Job(Path(), Path(), options=FillOptions(resolution=16))
    print("| cubes | where | s | jobs' own s | beside them, ms a job |")
    print("|---|---|---|---|---|")
    with cluster(work / "dask-tiny") as found, connect(found.address) as client:
        few, some = count // 20, count // 4
        rounds = (
            *((number, "local", None) for number in (few, some)),
            *((number, "Dask", client) for number in (few, some, count)),
        )
        for number, where, how in rounds:
            out = work / f"out-{where}-{number}-{os.getpid()}"
            items = [
                item_of(replace(job, model=folder / f"c{k}.stl"), f"c{k}", Path(f"c{k}.stl"), out)
                for k in range(number)
            ]
            seconds, rows = timed(items, out, BatchOptions(workers=2), how)
            busy = sum(row.seconds or 0 for row in rows)
            beside = 1000 * (2 * seconds - busy) / number
            print(f"| {number} | {where} | {seconds:.1f} | {busy:.1f} | {beside:.1f} |", flush=True)
    return 0


def items_for(table: Path, work: Path, count: int, resolution: int) -> list[Item]:
    """The dev set in sizes and leans, bad files spread among them."""
    bad = work / "bad"
    bad.mkdir(exist_ok=True)
    for number, content in enumerate(BAD):
        (bad / f"bad{number}.stl").write_bytes(content)
    folder = work / "alone"
    options = FillOptions(resolution=resolution, vaults="none")
    variants = itertools.product((30.0, 40.0, 50.0), ("5", "10"), catalogue(table, group="dev"))
    items = []
    for size, lean, model in itertools.islice(variants, count - len(BAD)):
        path, up = model
        place = Placement(up=up or "+z", size_mm=size)
        job = Job(path, Path(), placement=place, options=replace(options, lean=lean))
        where = Path(f"{size:g}-{lean}") / path.name
        items.append(item_of(job, str(path), where, folder))
    for number in range(len(BAD)):
        job = Job(bad / f"bad{number}.stl", Path(), options=options)
        item = item_of(job, f"bad{number}", Path(f"bad{number}.stl"), folder)
        items.insert((number + 1) * len(items) // (len(BAD) + 1), item)
    return items


def timed(
    items: list[Item], folder: Path, how: BatchOptions, client=None
) -> tuple[float, list[Row]]:
    start = time.perf_counter()
    rows = list(run_batch(plan(items, folder, resume=False), how, client))
    return time.perf_counter() - start, rows


def parts(rows: list[Row]) -> list[Row]:
    return [row for row in rows if row.status == "part"]


if __name__ == "__main__":
    sys.exit(main())
