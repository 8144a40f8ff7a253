"""Runs pieces of work side by side, in threads, on the processors that this process may use.

The libraries that do the work (numpy, libigl, manifold3d, zlib) let other threads go on meanwhile.
What a piece returns may not depend on when it runs: the results are those of one after another.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from contextvars import copy_context
from typing import Generic, TypeVar

Result = TypeVar("Result")


def processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def side_by_side(work: Sequence[Callable[[], Result]]) -> list[Result]:
    """What each function returns, in their order; they begin in this order too.

    Where one raises an error, no more begin, and the error of the first one in the order is raised.
    """
    if len(work) <= 1 or processors() <= 1:
        return [each() for each in work]
    crew = _Crew(work)
    threads = [
        threading.Thread(target=copy_context().run, args=(crew.work,), daemon=True)
        for _ in range(min(processors(), len(work)) - 1)
    ]
    for thread in threads:
        thread.start()
    try:
        crew.work()
    finally:  # a signal ends the crew as well
        crew.stopped = True
    for thread in threads:
        thread.join()
    if crew.errors:
        raise crew.errors[min(crew.errors)]
    return [crew.results[number] for number in range(len(work))]


class _Crew(Generic[Result]):
    """Threads that take the next piece of work until there is none, or one has failed."""

    def __init__(self, work: Sequence[Callable[[], Result]]) -> None:
        self._work = work
        self._next = iter(range(len(work)))
        self._take = threading.Lock()
        self.stopped = False
        self.results: dict[int, Result] = {}
        self.errors: dict[int, Exception] = {}

    def work(self) -> None:
        while not self.stopped:
            with self._take:
                number = next(self._next, None)
            if number is None:
                return
            try:
                self.results[number] = self._work[number]()
            except Exception as error:  # raised by the thread that asked for the work
                self.errors[number] = error
                self.stopped = True
