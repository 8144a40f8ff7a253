"""A batch on an existing Dask cluster: the same jobs, sent to its workers.

A job whose worker dies is run on another by the scheduler; how often is the scheduler's own setting
(distributed.scheduler.allowed-failures).  Nothing here is a scheduler, a queue or a protocol.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any
from uuid import uuid4

from printprep.batches.apart import run_apart
from printprep.batches.item import Item
from printprep.batches.local import crash_facts
from printprep.batches.row import Told
from printprep.batches.work import run_one, run_sent
from printprep.errors import ToolError
from printprep.version import __version__

if TYPE_CHECKING:
    from distributed import Client

    from printprep.pipeline.job import Job

CONNECT_S = 10
IN_FLIGHT_PER_WORKER = 4


def connect(address: str) -> Client:
    """A client of the scheduler at an address like tcp://host:8786.

    Raises ToolError where Dask is not installed, or nothing answers there.
    """
    try:
        from distributed import Client
    except ImportError as error:
        raise ToolError(
            "A cluster needs dask.distributed, which is not installed.",
            "Install it: pip install 'printprep[cluster]'.",
        ) from error
    try:
        return Client(address, timeout=CONNECT_S, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise ToolError(
            f"No scheduler answers at {address}.",
            "Start one with `dask scheduler`, and give the address it prints.",
        ) from error


def check_workers(client: Client) -> None:
    """Raise ToolError where there is no worker, or one with another printprep or platform."""
    versions = client.run(_version_here)
    if not versions:
        raise ToolError("The cluster has no worker.", "Start some: dask worker ADDRESS.")
    wanted = _version_here()
    for worker, found in sorted(versions.items()):
        if found != wanted:
            raise ToolError(
                f"{worker} has {' on '.join(found)}; this machine has {' on '.join(wanted)}.",
                "Install the same printprep everywhere: parts are then the same to the byte.",
            )


def run_on_cluster(
    items: Sequence[Item],
    client: Client,
    *,
    transfer: bool = False,
    timeout_s: float | None = None,
) -> Iterator[tuple[Item, Told]]:
    """Each item with what came of it, as they end.

    transfer : send the models with the jobs and bring the parts back; else workers reach the same
    folders by the same paths.  timeout_s : for one job, which then runs in a process of its own.

    Raises ToolError where the workers do not fit this machine, or the scheduler is lost.
    """
    from distributed import as_completed

    check_workers(client)
    shares = _shares(client)
    waiting = deque(enumerate(items))
    # No more are sent than keep every worker busy: what waits costs neither side any memory
    window = IN_FLIGHT_PER_WORKER * len(shares)
    with client.as_current():
        ended = as_completed()
    futures: dict[Any, Item] = {}
    unread: list[tuple[Item, Told]] = []

    def send() -> None:
        number, item = waiting.popleft()
        try:
            content = item.job.model.read_bytes() if transfer else None
        except OSError as error:
            unread.append((item, Told("error", {"code": "input", "message": str(error)})))
            return
        job = item.job if transfer else _absolute(item.job)
        key = f"printprep-{uuid4().hex}-{number}"
        future = client.submit(_run_there, job, content, shares, timeout_s, key=key, pure=False)
        futures[future] = item
        ended.add(future)

    try:
        while futures or unread or waiting:
            while waiting and len(futures) < window:
                send()
            while unread:
                yield unread.pop()
            if futures:
                future = next(ended)
                item = futures.pop(future)
                told = _told(future)
                future.release()
                yield item, told
    finally:
        if futures:
            client.cancel(list(futures), force=True)


def _run_there(
    job: Job,
    content: bytes | None,
    shares: dict[str, tuple[int, int]],
    timeout_s: float | None,
) -> Told:
    """In a worker: bound to its share of the cores, in a process of its own if it has a limit."""
    from distributed import get_worker

    from printprep.processors import bind

    slot, slots = shares.get(get_worker().address, (0, 1))
    bind(slot, slots)
    run = run_one if timeout_s is None else partial(run_apart, timeout_s=timeout_s)
    return run(job) if content is None else run_sent(job, content, run)


def _told(future: Any) -> Told:
    from concurrent.futures import CancelledError

    from distributed import KilledWorker
    from distributed.comm import CommClosedError

    try:
        told: Told = future.result()
    except KilledWorker:
        return Told("crashed", crash_facts(None))
    except (CancelledError, CommClosedError) as error:
        raise ToolError(
            "The scheduler was lost.", "Start it again, and go on with --resume."
        ) from error
    return told


def _shares(client: Client) -> dict[str, tuple[int, int]]:
    """For each worker: which it is on its machine, and how many are there."""
    by_host: dict[str, list[str]] = {}
    for address, info in client.scheduler_info(n_workers=-1)["workers"].items():
        by_host.setdefault(info["host"], []).append(address)
    return {
        address: (slot, len(here))
        for here in by_host.values()
        for slot, address in enumerate(sorted(here))
    }


def _version_here() -> tuple[str, str]:
    """This process's printprep and platform: parts are the same to the byte where these are."""
    import platform

    python = ".".join(platform.python_version_tuple()[:2])
    return f"printprep {__version__}", f"{platform.system()} {platform.machine()}, Python {python}"


def _absolute(job: Job) -> Job:
    from dataclasses import replace

    return replace(
        job,
        model=Path(job.model).absolute(),
        output=Path(job.output).absolute(),
        plugs=None if job.plugs is None else job.plugs.absolute(),
        report=None if job.report is None else job.report.absolute(),
    )
