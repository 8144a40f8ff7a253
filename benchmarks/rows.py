"""What the tables have in common: the catalogue's models, and rows written as markdown."""

from __future__ import annotations

import csv
from collections.abc import Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any


def catalogue(path: Path, only: Collection[str] | None = None) -> list[tuple[Path, str]]:
    """The catalogue's dev models, in its order, each with the axis that is up.

    only : file stems, all without.
    """
    with path.open(encoding="utf-8", newline="") as handle:
        rows = [row for row in csv.DictReader(handle) if row["set"] == "dev"]
    models = [(path.parent / "dev" / row["file"], row["up"]) for row in rows]
    return [pair for pair in models if not only or pair[0].stem in only]


def markdown_lines(
    columns: Sequence[tuple[str, str, str]], rows: Iterable[Mapping[str, Any]]
) -> list[str]:
    """The lines of a table.

    columns : title, key of a row, and format of each; what a row lacks, or has as None, is a dash.
    """
    lines = [
        "| " + " | ".join(title for title, _, _ in columns) + " |",
        "|" + "---|" * len(columns),
    ]
    for row in rows:
        cells = ["–" if row.get(key) is None else text.format(row[key]) for _, key, text in columns]
        lines.append("| " + " | ".join(cells) + " |")
    return lines
