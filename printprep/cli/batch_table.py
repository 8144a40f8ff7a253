"""A CSV of models: a column `file`, and any option of `hollow` as a column, `output` too.

A cell is parsed by the very parser of the command line, so that a table takes what the options take
and refuses what they refuse.  An empty cell leaves the batch's own option.
"""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

import click

from printprep.batches.item import SUFFIXES, Item, item_of
from printprep.cli.part_options import job_of, part_options
from printprep.errors import InputError, UsageError
from printprep.input_file import check_plain_file
from printprep.wording import did_you_mean, shortened

FILE, OUTPUT = "file", "output"
_YES, _NO = ("yes", "true", "1"), ("no", "false", "0")
# A table is text that a person made: a million models are a file of a few hundred megabytes.
MOST_ROWS = 1_000_000
_TABLE_BYTES_MAX = 256 << 20


def items_in(
    table: Path, given: Mapping[str, Any], folder: Path, suffix: str, fail_on: str
) -> list[Item]:
    """The models of a table; the options given hold where a cell is empty.

    Files are found beside the table; their folders below it are kept in the output.

    Raises
    ------
    InputError : the table cannot be read.
    UsageError : columns, cells or files that cannot be, all of them in one message.
    """
    items, wrong = [], []
    for line, row in _rows(table):
        try:
            items.append(_item(table, row, given, folder, suffix, fail_on))
        except (UsageError, click.UsageError, InputError) as error:
            what = error.format_message() if isinstance(error, click.UsageError) else error.message
            wrong.append(f"line {line}: {shortened(what, 300)}")
    if wrong:
        more = f" (and {len(wrong) - 10} more)" if len(wrong) > 10 else ""
        raise UsageError(f"{table}: {' '.join(wrong[:10])}{more}", "Nothing was started.")
    return items


def _rows(table: Path) -> Iterator[tuple[int, dict[str, str]]]:
    """Each row with its line; columns by option name without dashes."""
    check_plain_file(table, _TABLE_BYTES_MAX)
    try:
        with table.open(encoding="utf-8-sig", newline="") as file:
            reader = csv.DictReader(file)
            columns = [(name or "").strip().lstrip("-") for name in reader.fieldnames or ()]
            _check_columns(table, columns)
            for count, row in enumerate(reader):
                if count >= MOST_ROWS:
                    raise InputError(f"{table} has over {MOST_ROWS} rows.", "Split it.")
                if None in row:
                    raise UsageError(
                        f"{table}: line {reader.line_num}: it has more cells than columns.",
                        "Quote cells that hold commas.",
                    )
                cells = [(value or "").strip() for value in row.values()]
                if any("\0" in cell for cell in cells):
                    raise InputError(
                        f"{table}: line {reader.line_num}: a cell holds a zero character.",
                        "Save the table as text in UTF-8.",
                    )
                if any(cells):
                    yield reader.line_num, dict(zip(columns, cells, strict=True))
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{table} cannot be read as CSV: {error}.", "Save it as UTF-8.") from error


def _check_columns(table: Path, columns: list[str]) -> None:
    options = _options()
    if FILE not in columns:
        raise UsageError(f"{table} has no column {FILE}.", "Give each model's file in it.")
    for name in columns:
        if columns.count(name) > 1:
            raise UsageError(f"{table} has the column {shortened(name)} twice.", "Keep one.")
        if name not in (FILE, OUTPUT, *options):
            known = (FILE, OUTPUT, *options)
            hint = did_you_mean(name, known) or f"Columns are {', '.join(known)}."
            what = f"{shortened(name)} is not an option of `printprep hollow`"
            raise UsageError(f"{table}: {what}.", hint)


def _item(
    table: Path,
    row: Mapping[str, str],
    given: Mapping[str, Any],
    folder: Path,
    suffix: str,
    fail_on: str,
) -> Item:
    from printprep.pipeline.job import check_settings

    name = row[FILE]
    if not name:
        raise UsageError("the column file is empty.")
    model = table.parent / name
    try:
        there = model.is_file()
    except (OSError, ValueError):  # a name that no file can have
        there = False
    if not there:
        raise InputError(f"the file {shortened(name, 200)} does not exist.")
    cells = {key: cell for key, cell in row.items() if cell and key not in (FILE, OUTPUT)}
    words = [word for key, cell in cells.items() for word in _words(key, cell)]
    context = _ROW.make_context("row", words, default_map=dict(given))
    place = _place(row.get(OUTPUT) or _below(name), suffix)
    output = Path(f"part{suffix}")
    job = job_of(dict(context.params), model=model, output=output, plugs=None, fail_on=fail_on)
    check_settings(job)
    return item_of(job, name, place, folder, suffix)


def _below(name: str) -> str:
    """Where a file's part goes: its place below the table, its name alone for one elsewhere."""
    path = Path(name)
    return path.name if path.is_absolute() or ".." in path.parts else name


def _place(output: str, suffix: str) -> Path:
    """A part's place below the batch's folder.  Raises UsageError for one that is not below it."""
    path = Path(output)
    if path.is_absolute() or ".." in path.parts:
        raise UsageError(f"output is {output!r}, which is not below the folder of the batch.")
    return path if path.suffix.lower() in SUFFIXES else Path(f"{output}{suffix}")


def _words(name: str, cell: str) -> list[str]:
    """A cell as words of a command line; several values of one option are parted by semicolons.

    Raises UsageError for a flag that is neither yes nor no.
    """
    option = _options()[name]
    if option.multiple:
        return [word for value in cell.split(";") for word in (f"--{name}", value.strip())]
    if not option.is_flag:
        return [f"--{name}", cell]
    if cell.lower() in _YES:
        return [f"--{name}"]
    if cell.lower() in _NO:
        return option.secondary_opts[:1]
    raise UsageError(f"{name} is {cell!r}, which is neither yes nor no.")


def _options() -> dict[str, click.Option]:
    """The options of a part by their long names without dashes."""
    return {
        opt.lstrip("-"): option
        for option in _ROW.params
        if isinstance(option, click.Option)
        for opt in option.opts
        if opt.startswith("--")
    }


@click.command("row", add_help_option=False)
@part_options
def _row(**options: Any) -> None:
    """Parses one row; it is never run."""
    del options


_ROW: click.Command = _row
