"""One job for many inputs, as many at once as there are workers: the pool that every batch uses."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from multiprocessing import get_context
from typing import TypeVar

from printprep.errors import UsageError

Item = TypeVar("Item")
Result = TypeVar("Result")


def run_each(
    job: Callable[[Item], Result], items: Sequence[Item], workers: int = 1
) -> Iterator[tuple[Item, Result]]:
    """Each item with what the job makes of it, in the order they are done.

    job : a function that pickles, and that catches what must not end the others.
    workers : processes; one does the work in this process.

    Raises UsageError for fewer than one worker, and whatever the job raises.
    """
    if workers < 1:
        raise UsageError(f"{workers} workers cannot work.", "Give a whole number of at least 1.")
    if workers == 1 or len(items) <= 1:
        for item in items:
            yield item, job(item)
        return
    # Processes begin afresh ("spawn") on every system: forking would copy threads' locks.
    with ProcessPoolExecutor(min(workers, len(items)), get_context("spawn")) as pool:
        waiting: dict[Future[Result], Item] = {pool.submit(job, item): item for item in items}
        for future in as_completed(waiting):
            yield waiting[future], future.result()
