"""A batch as it runs: one moving line on a terminal, a line a row in a pipe, rows as JSON."""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Iterator
from contextlib import AbstractContextManager, nullcontext
from typing import TYPE_CHECKING

from printprep.batches.summary import counts_of
from printprep.wording import counted, printable

if TYPE_CHECKING:
    from rich.status import Status

    from printprep.batches.row import Row
    from printprep.batches.run import Planned


def follow(
    planned: Planned, ended: Iterator[Row], *, as_json: bool = False, quiet: bool = False
) -> list[Row]:
    """All rows of a batch, told as they end; returns them, the ones that stood already first.

    Rows go to stdout, a line each; the moving line goes to stderr, where a person watches it.
    """
    rows = list(planned.kept)
    start, total = time.perf_counter(), len(planned.items)
    if planned.kept and not (as_json or quiet):
        _print(f"{counted(len(planned.kept), 'model')} complete and unchanged: skipped")
    with _line(quiet or as_json) as line:
        for row in ended:
            rows.append(row)
            if as_json:
                _print(json.dumps(row.to_json(), allow_nan=False))
            elif not quiet or row.status != "part":
                _print(printable(row_line(row)))
            if line is not None:
                line.update(_progress(rows, len(planned.kept), total, time.perf_counter() - start))
    if not (as_json or quiet):
        _print(_end(rows))
    return rows


def row_line(row: Row) -> str:
    """One row for a person."""
    if row.status == "part":
        found = "".join(f", {count} {name}" for name, count in row.findings.items())
        return (
            f"{row.output}: {row.solid_mass_g:.1f} g → {row.mass_g:.1f} g, "
            f"tips at {_deg(row.tilt_deg)}{found}"
        )
    if row.status == "stopped":
        return f"{row.output}: not written: {', '.join(row.rules)} reached the --fail-on level"
    return f"{row.output}: {row.status}: {row.message}"


def _deg(tilt_deg: float | None) -> str:
    return "no contact" if tilt_deg is None else f"{tilt_deg:.1f}°"


def _progress(rows: list[Row], kept: int, total: int, seconds: float) -> str:
    done = len(rows) - kept
    rate = done / seconds if seconds > 0 else 0.0
    failed = sum(row.status != "part" for row in rows)
    left = (total - len(rows)) / rate if rate else 0.0
    return (
        f"{len(rows)} of {total}, {failed} failed, {60 * rate:.1f} a minute, "
        f"about {_span(left)} left"
    )


def _span(seconds: float) -> str:
    minutes = round(seconds / 60)
    return f"{minutes // 60} h {minutes % 60} min" if minutes >= 60 else f"{minutes} min"


def _end(rows: list[Row]) -> str:
    counts = counts_of(rows)
    words = ", ".join(f"{count} {status}" for status, count in counts.items()) or "nothing to do"
    parts = [row for row in rows if row.status == "part"]
    before = sum(row.solid_mass_g or 0.0 for row in parts)
    after = sum(row.mass_g or 0.0 for row in parts)
    return f"\n{counted(len(rows), 'model')}: {words}; {before:.0f} g → {after:.0f} g"


def _line(silent: bool) -> AbstractContextManager[Status | None]:
    from rich.console import Console

    if silent or not sys.stderr.isatty():
        return nullcontext()
    return Console(stderr=True).status("Starting …")


def _print(text: str) -> None:
    sys.stdout.write(text + "\n")
    sys.stdout.flush()
