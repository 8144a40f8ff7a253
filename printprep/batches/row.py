"""What came of one model of a batch: one frozen row, as the journal and the summary hold it."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from printprep.output.numbers import number, plain

if TYPE_CHECKING:
    from printprep.errors import PrintprepError
    from printprep.pipeline.job import JobResult

Status = Literal["part", "stopped", "error", "crashed", "timeout", "memory"]
"""part: written.  stopped: a finding reached --fail-on.  error: the model or its options.
crashed: the process died.  timeout, memory: it needed more than it was given."""

FINAL: frozenset[Status] = frozenset({"part", "stopped", "error"})
"""What the same model with the same options ends with again."""


@dataclass(frozen=True)
class Row:
    """One model.

    name : the input as it was named;  output : where its part goes, below the batch's folder.
    key : hash of all that the part depends on;  output_sha256 : of the written file.
    code, message, hint : of an error, as a single run prints them.
    report : the page about it, beside its part, below the batch's folder; None where none is made.
    findings : how many of each severity;  rules : ids of warnings and errors, sorted.
    seconds : of the job;  peak_mib : of its process, None where the system does not tell.
    """

    name: str
    output: str
    status: Status
    key: str = ""
    output_sha256: str | None = None
    code: str | None = None
    message: str | None = None
    hint: str | None = None
    solid_mass_g: float | None = None
    mass_g: float | None = None
    tilt_solid_deg: float | None = None
    tilt_deg: float | None = None
    wall_min_mm: float | None = None
    cavities: int | None = None
    report: str | None = None
    findings: Mapping[str, int] = field(default_factory=dict)
    rules: tuple[str, ...] = ()
    seconds: float | None = None
    peak_mib: float | None = None

    def to_json(self) -> dict[str, Any]:
        """As plain values."""
        values: dict[str, Any] = plain(self)
        return values

    @classmethod
    def from_json(cls, text: bytes | str) -> Row:
        """Read what ``to_json`` wrote.  Raises ValueError for anything else."""
        from pydantic import TypeAdapter

        data = json.loads(text)
        row: Row = TypeAdapter(cls).validate_python(data)
        return row


@dataclass(frozen=True)
class Told:
    """What a row says besides its name, output and key: it travels from worker to client."""

    status: Status
    facts: Mapping[str, Any]
    output: bytes | None = None
    """The part's file, where the worker could not write it itself."""


def told_by(done: JobResult, output_sha256: str | None) -> dict[str, Any]:
    """A finished job's facts, by the names of a row."""
    result = done.result
    counts: dict[str, int] = {}
    for item in done.findings:
        counts[item.severity] = counts.get(item.severity, 0) + 1
    return {
        "output_sha256": output_sha256,
        "solid_mass_g": number(result.solid_mass_g),
        "mass_g": number(result.mass_g),
        "tilt_solid_deg": number(result.tilt_solid_deg),
        "tilt_deg": number(result.tilt_deg),
        "wall_min_mm": number(result.wall_min_mm),
        "cavities": len(result.part.cavities),
        "findings": dict(sorted(counts.items())),
        "rules": tuple(sorted({item.rule for item in done.findings if item.severity != "info"})),
    }


def failed_by(error: PrintprepError) -> dict[str, Any]:
    """An error's facts, by the names of a row."""
    return {
        "code": error.code,
        "message": " ".join(error.message.split()),
        "hint": error.hint,
    }
