"""The pool of worker processes that every batch uses: whatever ends one job does not end the rest.

The pool is Pebble's: a job that takes too long is ended with its process, and a process that dies
is one job's end and not the pool's.
"""

from __future__ import annotations

import multiprocessing
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from typing import Any, TypeVar

from printprep.errors import UsageError
from printprep.processors import bind

Item = TypeVar("Item")
Result = TypeVar("Result")


class WorkerDiedError(Exception):
    """The process that ran a job died; exit_code : negative for a signal, None where unknown."""

    def __init__(self, exit_code: int | None) -> None:
        how = f" by signal {-exit_code}" if exit_code is not None and exit_code < 0 else ""
        super().__init__(f"The process died{how}.")
        self.exit_code = exit_code


def run_here(
    job: Callable[[Item], Result], items: Sequence[Item], workers: int = 1
) -> Iterator[tuple[Item, Result]]:
    """Each item with the job's result for it, as they end; one worker is this process.

    job : a function that can be pickled, and that catches errors that must not end the others.

    Raises UsageError for fewer than one worker, and what the job raises, WorkerDiedError among it.
    """
    if workers < 1:
        raise UsageError(f"{workers} workers are too few.", "Give a whole number of at least 1.")
    if workers == 1 or len(items) <= 1:
        for item in items:
            yield item, job(item)
        return
    for item, ended in run_apart(job, items, workers):
        yield item, ended()


def run_apart(
    job: Callable[[Item], Result],
    items: Sequence[Item],
    workers: int,
    *,
    timeout_s: float | None = None,
    cost: Callable[[Item], float] = lambda item: 0.0,
    budget: float = 0.0,
) -> Iterator[tuple[Item, Callable[[], Result]]]:
    """Each item, in a process that is not this one, with a function that gives its result.

    That function raises TimeoutError for a job that took over ``timeout_s``, WorkerDiedError for
    one whose process died, and what the job raised.

    cost, budget : a job starts when its cost fits beside those that run, or when none runs.
    """
    from pebble import ProcessPool

    if not items:
        return
    count = min(workers, len(items))
    # New processes ("spawn") on every system: forking would copy the locks of threads.
    context = multiprocessing.get_context("spawn")
    slots = context.Value("i", 0)
    pool = ProcessPool(count, context=context, initializer=_begin, initargs=[slots, count])
    waiting = deque(items)
    running: dict[Future[Result], tuple[Item, float]] = {}
    try:
        while waiting or running:
            used = sum(each for _, each in running.values())
            while waiting and len(running) < count:
                each = cost(waiting[0])
                if running and used + each > budget:
                    break
                item = waiting.popleft()
                running[pool.schedule(job, args=[item], timeout=timeout_s)] = (item, each)
                used += each
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in done:
                yield running.pop(future)[0], _Ended(future)
        pool.close()
    finally:
        pool.stop()
        pool.join()


class _Ended:
    """The result of a future, with a process that died as WorkerDiedError."""

    def __init__(self, future: Future[Any]) -> None:
        self._future = future

    def __call__(self) -> Any:
        from pebble import ProcessExpired

        try:
            return self._future.result()
        except ProcessExpired as error:
            raise WorkerDiedError(error.exitcode) from error


def _begin(slots: Any, count: int) -> None:
    """A worker's start: it leaves Ctrl-C to its parent, and takes its share of the processors."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    with slots.get_lock():
        slot = slots.value
        slots.value += 1
    bind(slot % count, count)
