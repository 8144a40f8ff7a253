"""Profiles for a person at a terminal: the list, and what an import took."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.cells import cell_len
from rich.console import Console
from rich.table import Table

from printprep.profile_import.run import Imported
from printprep.profiles import Profile
from printprep.wording import printable


def show_profiles(
    console: Console,
    shipped: Sequence[Profile],
    own: Sequence[Profile],
    refused: Mapping[str, str],
    folder: Path,
) -> None:
    """Print a row for each profile, the default first, then those of the user.

    refused : name → why, for files in ``folder``, that of the user's own, that are no profiles.
    """
    console.print(_table(console, shipped))
    if own or refused:
        console.print(f"\nYour own, in {folder}:", soft_wrap=True)
    if own:
        console.print(_table(console, own))
    for name, reason in refused.items():
        console.print(f"{name} is not usable. {reason}")
    console.print("\n`printprep profiles show NAME` shows the source of each figure.")
    if not own:
        console.print("`printprep profiles new NAME` makes one of your own.")


def show_import(console: Console, done: Imported, path: Path) -> None:
    """Print what a profile took from a slicer's settings, what they lack, and where it is."""
    console.print(f"Taken from the settings of {done.program}:")
    console.print(_rows([(item.key, _plain(item.value), item.origin) for item in done.taken]))
    if done.missing:
        console.print(f"\nNot in the files, so taken from {done.base}:")
        console.print(
            _rows(
                [
                    (item.key, _plain(_value(done.profile, item.key)), item.why)
                    for item in done.missing
                ]
            )
        )
    if done.absent:
        console.print(
            f"\nThey build on {', '.join(done.absent)}, which was not given: export that too, and "
            "give all files."
        )
    console.print(f"\nAll other keys are those of {done.base}, wall_mm and stability among them.")
    console.print(f"Written: {path}", soft_wrap=True)
    console.print(f"Use it with --profile {done.profile.name}.")


def import_json(done: Imported, path: Path) -> dict[str, Any]:
    """The same as data."""
    return {
        "profile": done.profile.model_dump(mode="json"),
        "file": str(path),
        "from": done.base,
        "program": done.program,
        "taken": [
            {"key": item.key, "value": item.value, "origin": item.origin} for item in done.taken
        ],
        "missing": [
            {"key": item.key, "value": _value(done.profile, item.key), "why": item.why}
            for item in done.missing
        ],
        "absent": list(done.absent),
    }


def _value(profile: Profile, key: str) -> Any:
    value: Any = profile
    for part in key.split("."):
        value = getattr(value, part)
    return value


def _plain(value: object) -> str:
    if isinstance(value, tuple):
        return " × ".join(f"{side:g}" for side in value)
    return f"{value:g}" if isinstance(value, float) else "not set" if value is None else str(value)


def _rows(rows: Sequence[tuple[str, str, str]]) -> Table:
    table = Table.grid(padding=(0, 2, 0, 0))
    table.add_column(no_wrap=True)
    table.add_column(overflow="fold")
    table.add_column(style="dim", overflow="fold")
    for row in rows:
        table.add_row(*(printable(text) for text in row))
    return table


def _table(console: Console, profiles: Sequence[Profile]) -> Table:
    """A row for each profile, without the last columns where the screen is too narrow for them."""
    heads = ("name", "process", "material", "wall", "layer", "bed, mm")
    rows = [
        (
            item.name,
            item.process,
            item.material.name,
            f"{item.wall_mm:g}",
            f"{item.printer.layer_height_mm:g}",
            " × ".join(f"{side:g}" for side in item.printer.bed_mm),
        )
        for item in profiles
    ]
    widths = [max(cell_len(row[k]) for row in (heads, *rows)) + 1 for k in range(len(heads))]
    shown = max(k for k in range(1, len(heads) + 1) if k == 1 or sum(widths[:k]) <= console.width)
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for head in heads[:shown]:
        table.add_column(head, overflow="fold", no_wrap=shown > 1)
    for row in rows:
        table.add_row(*row[:shown])
    return table
