"""Shows which stage of a long run is at work: one line on stderr, or nothing.

The code of a stage runs inside ``progress.stage(name)``, with a name from ``STAGES``.  A
``Stopwatch`` also measures how long each stage takes.
"""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from types import MappingProxyType
from typing import Literal, Protocol

Stage = Literal[
    "read",
    "repair",
    "voxelize",
    "cavity",
    "supports",
    "base",
    "solve",
    "advice",
    "check",
    "alternative",
    "simulate",
    "draw",
    "page",
    "write",
    "read-part",
    "slice",
    "slice-supports",
    "slice-solid",
    "slice-baselines",
]
"""Names of stages: a run's seconds are told by them."""

STAGES: Mapping[Stage, str] = MappingProxyType(
    {
        "read": "Reading the model",
        "repair": "Repairing the surface",
        "voxelize": "Measuring the depth below the surface",
        "cavity": "Cutting the cavity",
        "supports": "Building vaults under the ceilings",
        "base": "Choosing the base",
        "solve": "Finding the lightest filling that stands",
        "advice": "Looking for a base or pose that makes it stand",
        "check": "Checking walls, tilt angle and surface",
        "alternative": "Estimating the other fill",
        "simulate": "Simulating how it stands",
        "draw": "Drawing the simulation",
        "page": "Making the page",
        "write": "Writing the file",
        "read-part": "Reading the part",
        "slice": "Slicing the part",
        "slice-supports": "Slicing it with supports switched on",
        "slice-solid": "Slicing the solid model",
        "slice-baselines": "Slicing the model with plain infill",
    }
)


SHOWN_AFTER_S = 1.0


class Progress(Protocol):
    """Receives the stages of a run."""

    def stage(self, name: Stage) -> AbstractContextManager[None]:
        """A context that stays open while stage ``name`` (a key of ``STAGES``) runs."""
        ...


class Silent:
    """Shows nothing: the default in Python, with ``-q``, and where stderr is redirected."""

    def stage(self, name: Stage) -> AbstractContextManager[None]:
        del name
        return nullcontext()


class Spinner:
    """Shows one moving line on stderr while a stage runs, and removes it afterwards.

    after_s : the line is shown once the run has taken so many seconds: what is done at once says
        nothing.
    """

    def __init__(self, after_s: float = SHOWN_AFTER_S) -> None:
        from rich.console import Console

        self._console = Console(stderr=True)
        self._due = time.monotonic() + after_s

    @contextmanager
    def stage(self, name: Stage) -> Iterator[None]:
        status = self._console.status(f"{STAGES[name]} …")
        wait_s = self._due - time.monotonic()
        if wait_s <= 0:
            with status:
                yield
            return
        timer = threading.Timer(wait_s, status.start)
        timer.daemon = True
        timer.start()
        try:
            yield
        finally:
            timer.cancel()
            timer.join()  # it may just be starting the line
            status.stop()


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
        self.seconds: dict[Stage, float] = {}

    @contextmanager
    def stage(self, name: Stage) -> Iterator[None]:
        """Add the time of the block to this stage."""
        start = time.perf_counter()
        with self._progress.stage(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
