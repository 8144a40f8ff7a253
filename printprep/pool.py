"""The pool of worker processes that every batch uses."""

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
    """Each item with the job's result for it, in the order in which they are done.

    job : a function that can be pickled, and that catches errors that must not end the others.
    workers : number of processes; with 1, the work is done in this process.

    Raises UsageError for fewer than one worker, and whatever the job raises.
    """
    if workers < 1:
        raise UsageError(f"{workers} workers are too few.", "Give a whole number of at least 1.")
    if workers == 1 or len(items) <= 1:
        for item in items:
            yield item, job(item)
        return
    # New processes ("spawn") on every system: forking would copy the locks of threads.
    with ProcessPoolExecutor(min(workers, len(items)), get_context("spawn")) as pool:
        waiting: dict[Future[Result], Item] = {pool.submit(job, item): item for item in items}
        for future in as_completed(waiting):
            yield waiting[future], future.result()
