"""Seconds per stage, told to whoever watches."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from printprep.progress import Progress


class Stopwatch:
    """Measures the stages of a run; ``seconds`` holds them by name, in order.

    Seconds go to the summary alone, never into a file that must be the same next time.
    """

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Time what runs inside, under this name."""
        start = time.perf_counter()
        with self._progress.stage(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
