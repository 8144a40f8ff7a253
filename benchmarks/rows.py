"""What the benchmark tables share: arguments, the catalogue's models, rows, and Markdown."""

from __future__ import annotations

import argparse
import csv
import json
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from printprep.errors import PrintprepError

Row = dict[str, Any]
Measure = Callable[[Path, str, Row], Row]
"""Called with a model, its axis that is up, and the row kept of it (empty for none)."""


def table_parser(
    doc: str | None, *, profile: str = "fdm-pla-0.4", only: Sequence[str] = ()
) -> argparse.ArgumentParser:
    """A parser with the arguments that every table takes.

    doc : a script's docstring, whose first line describes it;  only : the default models, all when
    empty.
    """
    parser = argparse.ArgumentParser(description=(doc or "").partition("\n")[0])
    parser.add_argument("catalogue", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True, help="Markdown table")
    parser.add_argument("-p", "--profile", default=profile)
    parser.add_argument("--size", type=float, default=100.0, help="longest side in mm")
    parser.add_argument("--only", nargs="*", default=only, help="file stems")
    parser.add_argument("--json", type=Path, help="the rows as JSON, kept from run to run")
    return parser


def catalogue(
    path: Path, only: Collection[str] | None = None, group: str = "dev"
) -> list[tuple[Path, str]]:
    """The models of one set of a catalogue, in its order, each with its axis that is up.

    only : file stems; all models when empty.
    """
    with path.open(encoding="utf-8", newline="") as handle:
        rows = [row for row in csv.DictReader(handle) if row["set"] == group]
    models = [(path.parent / group / row["file"], row["up"]) for row in rows]
    return [pair for pair in models if not only or pair[0].stem in only]


def measured_rows(
    chosen: argparse.Namespace,
    measure: Measure,
    markdown: Callable[[list[Row]], str],
    *,
    done: Callable[[Row], bool] = lambda row: "error" not in row,
) -> list[Row]:
    """Measure every model of a catalogue, and write the table after each.

    Rows in the file of --json that are ``done`` are not measured again.  An error becomes a row.

    chosen : arguments of `table_parser`.
    """
    kept: dict[str, Row] = {}
    if chosen.json and chosen.json.is_file():
        kept = {row["model"]: row for row in json.loads(chosen.json.read_text("utf-8"))}
    rows = []
    for path, up in catalogue(chosen.catalogue, chosen.only):
        row = kept.get(path.stem)
        if row is None or not done(row):
            try:
                row = measure(path, up, row or {})
            except (PrintprepError, ArithmeticError) as error:
                row = {"model": path.stem, "error": str(error)}
            sys.stderr.write(json.dumps(row) + "\n")
        rows.append(row)
        kept[path.stem] = row
        chosen.output.write_text(markdown(rows), encoding="utf-8", newline="\n")
        if chosen.json:
            text = json.dumps(list(kept.values()), indent=1) + "\n"
            chosen.json.write_text(text, encoding="utf-8", newline="\n")
    return rows


def markdown_lines(
    columns: Sequence[tuple[str, str, str]], rows: Iterable[Mapping[str, Any]]
) -> list[str]:
    """The lines of a table.

    columns : title, key of a row, and format of each; a missing value, or None, is a dash.
    """
    lines = [
        "| " + " | ".join(title for title, _, _ in columns) + " |",
        "|" + "---|" * len(columns),
    ]
    for row in rows:
        cells = ["–" if row.get(key) is None else text.format(row[key]) for _, key, text in columns]
        lines.append("| " + " | ".join(cells) + " |")
    return lines
