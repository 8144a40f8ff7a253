"""The list of profiles for a person at a terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from rich.console import Console
from rich.table import Table

from printprep.profiles import Profile


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
    console.print(_table(shipped))
    if own or refused:
        console.print(f"\nYour own, in {folder}:", soft_wrap=True)
    if own:
        console.print(_table(own))
    for name, reason in refused.items():
        console.print(f"{name} is not usable. {reason}")
    console.print("\n`printprep profiles show NAME` shows the source of each figure.")
    if not own:
        console.print("`printprep profiles new NAME` makes one of your own.")


def _table(profiles: Sequence[Profile]) -> Table:
    table = Table(box=None, padding=(0, 1, 0, 0), header_style="dim")
    for head in ("name", "process", "material", "wall", "layer", "bed, mm"):
        table.add_column(head, no_wrap=True)
    for item in profiles:
        bed = " × ".join(f"{side:g}" for side in item.printer.bed_mm)
        table.add_row(
            item.name,
            item.process,
            item.material.name,
            f"{item.wall_mm:g}",
            f"{item.printer.layer_height_mm:g}",
            bed,
        )
    return table
