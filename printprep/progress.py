"""How a long run tells what it is doing: one stage at a time, on stderr, or not at all.

Whoever runs a stage opens ``progress.stage(name)`` around it, by the names in ``STAGES``.
A ``Stopwatch`` measures the stages of a run as it tells them.
"""

from __future__ import annotations

import sys
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
        "repair": "Making it a solid",
        "voxelize": "Measuring how deep the material is",
        "cavity": "Cutting the cavity",
        "supports": "Building vaults under the ceilings",
        "base": "Choosing a base",
        "solve": "Finding the lightest filling that stands",
        "advice": "Looking for what would make it stand",
        "check": "Checking walls, tilt angle and surface",
        "alternative": "Estimating the other fill",
        "simulate": "Simulating how it stands",
        "draw": "Drawing the simulation",
        "write": "Writing the file",
        "read-part": "Reading the part",
        "slice": "Slicing the part",
        "slice-supports": "Slicing it with supports switched on",
        "slice-solid": "Slicing the solid model",
        "slice-baselines": "Slicing the model with plain infill",
    }
)


class Progress(Protocol):
    """Whatever wants to know which stage runs."""

    def stage(self, name: Stage) -> AbstractContextManager[None]:
        """A context held open while stage ``name`` (a key of ``STAGES``) runs."""
        ...


class Silent:
    """Says nothing: the default of the Python interface, of ``-q`` and of a redirected stderr."""

    def stage(self, name: Stage) -> AbstractContextManager[None]:
        del name
        return nullcontext()


class Spinner:
    """One line on stderr that moves while a stage runs and leaves no trace."""

    def __init__(self) -> None:
        from rich.console import Console

        self._console = Console(stderr=True)

    @contextmanager
    def stage(self, name: Stage) -> Iterator[None]:
        with self._console.status(f"{STAGES[name]} …"):
            yield


SILENT: Progress = Silent()


def for_terminal(*, quiet: bool = False) -> Progress:
    """A spinner when a person watches stderr, silence otherwise."""
    return SILENT if quiet or not sys.stderr.isatty() else Spinner()


class Stopwatch:
    """Measures the stages of a run; ``seconds`` holds them by name, in order.

    Seconds go to the summary alone, never into a file that must be the same next time.
    """

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self.seconds: dict[Stage, float] = {}

    @contextmanager
    def stage(self, name: Stage) -> Iterator[None]:
        """Time what runs inside, under this name."""
        start = time.perf_counter()
        with self._progress.stage(name):
            yield
        self.seconds[name] = self.seconds.get(name, 0.0) + time.perf_counter() - start
