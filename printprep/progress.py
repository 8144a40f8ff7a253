"""Shows which stage of a long run is at work: one line on stderr, or nothing.

The code of a stage runs inside ``progress.stage(name)``, with a name from ``STAGES``.  A
``Stopwatch`` also measures how long each stage takes.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from types import MappingProxyType
from typing import Protocol

STAGES: Mapping[str, str] = MappingProxyType(
    {
        "read": "Reading the model",
        "repair": "Repairing the surface",
        "voxelize": "Measuring the depth below the surface",
        "supports": "Building supports inside the cavity",
        "base": "Choosing the base",
        "solve": "Finding the lightest filling that stands",
        "cavity": "Cutting the cavity",
        "advice": "Looking for a base or pose that makes it stand",
        "check": "Checking walls, stability and surface",
        "write": "Writing the file",
    }
)


class Progress(Protocol):
    """Receives the stages of a run."""

    def stage(self, name: str) -> AbstractContextManager[None]:
        """A context that stays open while stage ``name`` (a key of ``STAGES``) runs."""
        ...


class Silent:
    """Shows nothing: the default in Python, with ``-q``, and where stderr is redirected."""

    def stage(self, name: str) -> AbstractContextManager[None]:
        del name
        return nullcontext()


class Spinner:
    """Shows one moving line on stderr while a stage runs, and removes it afterwards."""

    def __init__(self) -> None:
        from rich.console import Console

        self._console = Console(stderr=True)

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        with self._console.status(f"{STAGES.get(name, name)} …"):
            yield


SILENT: Progress = Silent()


def for_terminal(*, quiet: bool = False) -> Progress:
    """A spinner where stderr is a terminal, silence elsewhere."""
    return SILENT if quiet or not sys.stderr.isatty() else Spinner()


class Stopwatch:
    """Passes the stages of a run on and measures them; ``seconds`` holds them by name, in order.

    The seconds go into the summary only, never into a file: the same input gives the same bytes.
    """

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.seconds: dict[str, float] = {}

    @contextmanager
    def stage(self, name: str) -> Iterator[None]:
        """Add the time of the block to this stage."""
        start = time.perf_counter()
        with self._progress.stage(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
