"""The summary of a batch: every row as CSV and as JSON, in the order of the models."""

from __future__ import annotations

import csv
import io
from collections import Counter
from collections.abc import Sequence
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from printprep.batches.row import Row
from printprep.files import write_atomically
from printprep.output.numbers import to_text
from printprep.version import __version__

if TYPE_CHECKING:
    from printprep.batches.run import Planned
    from printprep.page.index import IndexRow

CSV, JSON, PAGE = "summary.csv", "summary.json", "summary.html"


def write_summary(planned: Planned, rows: Sequence[Row]) -> tuple[Path, ...]:
    """Write summary.csv and summary.json into the batch's folder, and summary.html where rows have
    pages.

    Raises OutputError where the folder refuses.
    """
    place = {item.output: number for number, item in enumerate(planned.items)}
    ordered = sorted(rows, key=lambda row: place[row.output])
    paths = [planned.folder / CSV, planned.folder / JSON]
    write_atomically(paths[0], csv_text(ordered).encode("utf-8"))
    write_atomically(paths[1], to_text(summary_json(ordered)).encode("ascii"))
    if any(row.report is not None for row in ordered):
        from printprep.page.index import index_page

        paths.append(planned.folder / PAGE)
        write_atomically(paths[2], index_page(planned.folder.name, index_rows(ordered)))
    return tuple(paths)


def index_rows(rows: Sequence[Row]) -> tuple[IndexRow, ...]:
    """The rows as the page that links to their pages shows them."""
    from printprep.page.index import IndexRow

    return tuple(
        IndexRow(
            name=row.name,
            report=row.report,
            status=row.status,
            solid_mass_g=row.solid_mass_g,
            mass_g=row.mass_g,
            tilt_deg=row.tilt_deg,
            errors=row.findings.get("error", 0),
            warnings=row.findings.get("warning", 0),
            message=row.message,
        )
        for row in rows
    )


def summary_json(rows: Sequence[Row]) -> dict[str, Any]:
    """Counts, sums and all rows."""
    parts = [row for row in rows if row.status == "part"]
    return {
        "printprep": __version__,
        "models": len(rows),
        "counts": counts_of(rows),
        "solid_mass_g": round(sum(row.solid_mass_g or 0.0 for row in parts), 3),
        "mass_g": round(sum(row.mass_g or 0.0 for row in parts), 3),
        "rows": [row.to_json() for row in rows],
    }


def counts_of(rows: Sequence[Row]) -> dict[str, int]:
    """How many rows have each status, the parts first."""
    found: Counter[str] = Counter(row.status for row in rows)
    order = ("part", "stopped", "error", "crashed", "timeout", "memory")
    return {status: found[status] for status in order if found[status]}


def csv_text(rows: Sequence[Row]) -> str:
    """A line a row, a column a field; text that a spreadsheet would run is quoted as text."""
    names = [field.name for field in fields(Row)]
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(names)
    for row in rows:
        writer.writerow([_cell(getattr(row, name)) for name in names])
    return text.getvalue()


def _cell(value: object) -> object:
    if value is None:
        return ""
    if isinstance(value, str):
        return f"'{value}" if value[:1] in ("=", "+", "-", "@") else value
    if isinstance(value, tuple):
        return " ".join(value)
    if isinstance(value, dict):
        return " ".join(f"{name}:{count}" for name, count in value.items())
    return value
