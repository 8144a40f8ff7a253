"""A real Dask scheduler on loopback with worker processes, for tests and benchmarks."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from pathlib import Path

STARTS_IN_S = 60.0


@dataclass
class Cluster:
    """The scheduler's address, and the processes that were started."""

    address: str
    scheduler: subprocess.Popen[bytes]
    workers: list[subprocess.Popen[bytes]] = field(default_factory=list)

    def kill_scheduler(self) -> None:
        """End the scheduler."""
        os.killpg(self.scheduler.pid, signal.SIGKILL)

    def kill_worker(self, number: int = 0, *, restarts: bool = False) -> None:
        """End a worker as the system does when memory runs out.

        restarts : leave its nanny, which starts another one (Linux).
        """
        pid = self.workers[number].pid
        if not restarts:
            os.killpg(pid, signal.SIGKILL)
            return
        for child in Path(f"/proc/{pid}/task/{pid}/children").read_text().split():
            os.kill(int(child), signal.SIGKILL)


@contextmanager
def cluster(folder: Path, workers: int = 2, allowed_failures: int = 2) -> Iterator[Cluster]:
    """A scheduler at 127.0.0.1 and workers of one thread each; all of them end with the context.

    folder : for logs and the workers' own files.
    """
    folder.mkdir(parents=True, exist_ok=True)
    address_file = folder / "scheduler.json"
    environment = {
        **os.environ,
        "DASK_DISTRIBUTED__SCHEDULER__ALLOWED_FAILURES": str(allowed_failures),
        "DASK_DISTRIBUTED__WORKER__MEMORY__TERMINATE": "False",
        "MALLOC_TRIM_THRESHOLD_": "67108864",
        "MALLOC_MMAP_THRESHOLD_": "33554432",
        "PYTHONPATH": os.pathsep.join([*sys.path]),
    }

    def start(name: str, *words: str) -> subprocess.Popen[bytes]:
        log = (folder / f"{name}.log").open("wb")
        command = [sys.executable, "-m", "dask", *words]
        return subprocess.Popen(
            command, stdout=log, stderr=log, env=environment, cwd=folder, start_new_session=True
        )

    local = ("--host", "127.0.0.1", "--scheduler-file", str(address_file))
    scheduler = start("scheduler", "scheduler", *local, "--port", "0", "--no-dashboard")
    started = [scheduler]
    try:
        _wait_for(address_file)
        import json

        found = Cluster(json.loads(address_file.read_text(encoding="utf-8"))["address"], scheduler)
        one = ("--nworkers", "1", "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1")
        for number in range(workers):
            worker = start(f"worker{number}", "worker", found.address, *one)
            found.workers.append(worker)
            started.append(worker)
        if workers:
            _wait_for_workers(found.address, workers)
        yield found
    finally:
        for process in started:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def _wait_for(path: Path) -> None:
    end = time.monotonic() + STARTS_IN_S
    while not (path.exists() and path.stat().st_size):
        if time.monotonic() > end:
            raise TimeoutError(f"no scheduler after {STARTS_IN_S:g} s")
        time.sleep(0.1)


def _wait_for_workers(address: str, count: int) -> None:
    from distributed import Client

    with Client(address, set_as_default=False) as client:
        client.wait_for_workers(count, timeout=STARTS_IN_S)
