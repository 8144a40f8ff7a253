"""Runs pieces of work side by side, in threads, on the processors that this process may use.

It pays for what lets other threads go on meanwhile: numpy's sorts and sums of large arrays,
manifold3d's booleans, zlib.  What a piece returns may not depend on when it runs: the results are
those of one after another.

A ThreadPoolExecutor would go on with the work of a crew within a crew after a signal or an error,
and the interpreter waits for its threads at the end.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from contextvars import ContextVar, copy_context
from typing import Any, Generic, TypeVar

from printprep.processors import usable_processors

Result = TypeVar("Result")


def side_by_side(work: Sequence[Callable[[], Result]]) -> list[Result]:
    """What each function returns, in their order; they begin in this order too.

    Where one raises an error, no more begin, and the error of the first one in the order is raised.
    A signal, which interrupts this thread, also lets no more begin.
    """
    if len(work) <= 1 or usable_processors() <= 1:
        return [each() for each in work]
    crew = _Crew(work, _CREW.get())
    threads = [
        threading.Thread(target=copy_context().run, args=(crew.work_apart,), daemon=True)
        for _ in range(min(usable_processors(), len(work)) - 1)
    ]
    try:
        for thread in threads:
            thread.start()
        crew.work()
    except BaseException:
        crew.stop()
        raise
    for thread in threads:
        thread.join()
    return crew.ended()


class _StoppedError(Exception):
    """A crew was stopped because the one that it works for was."""


class _Crew(Generic[Result]):
    """Threads that take the next piece of work until there is none, or one has failed."""

    def __init__(self, work: Sequence[Callable[[], Result]], outer: _Crew[Any] | None) -> None:
        """outer : the crew that this one works for."""
        self._work = work
        self._outer = outer
        self._next = iter(range(len(work)))
        self._take = threading.Lock()
        self._stop = False
        self._results: dict[int, Result] = {}
        self._errors: dict[int, BaseException] = {}

    def stop(self) -> None:
        """Let no more work begin."""
        self._stop = True

    @property
    def stopped(self) -> bool:
        return self._stop or (self._outer is not None and self._outer.stopped)

    def work(self) -> None:
        """Work in the thread that asked: what interrupts it is raised."""
        self._go_on(Exception)

    def work_apart(self) -> None:
        """Work in another thread: whatever is raised there, is raised by ``ended``."""
        self._go_on(BaseException)

    def ended(self) -> list[Result]:
        """All results, or the first error."""
        for number in sorted(self._errors):
            if not isinstance(self._errors[number], _StoppedError):
                raise self._errors[number]
        if len(self._results) < len(self._work):
            raise _StoppedError
        return [self._results[number] for number in range(len(self._work))]

    def _go_on(self, told_later: type[BaseException]) -> None:
        token = _CREW.set(self)
        try:
            while not self.stopped:
                with self._take:
                    number = next(self._next, None)
                if number is None:
                    return
                try:
                    self._results[number] = self._work[number]()
                except told_later as error:
                    self._errors[number] = error
                    self._stop = True
        finally:
            _CREW.reset(token)


_CREW: ContextVar[_Crew[Any] | None] = ContextVar("crew", default=None)
