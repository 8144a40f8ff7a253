"""What the reader of a file has to say, as findings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from printprep.check.catalogue import finding
from printprep.types import Finding, ReadNote

_MADE: Mapping[str, Callable[[ReadNote], Finding]] = {
    "colours-lost": lambda note: finding("colours-lost", note.message, note.fix, severity="info"),
    "cut-short": lambda note: finding("cut-short", note.message, note.fix),
    "facet-count": lambda note: finding("facet-count", note.message, note.fix),
    "left-out": lambda note: finding("left-out", note.message, note.fix),
    "read-together": lambda note: finding("read-together", note.message, note.fix),
    "subtracted": lambda note: finding("subtracted", note.message, note.fix),
}


def reading_findings(notes: Iterable[ReadNote]) -> tuple[Finding, ...]:
    """The notes of a reader as findings, each under the id of its kind."""
    return tuple(_MADE[note.kind](note) for note in notes)
