"""Where summaries and findings go: stdout for a person, stderr when only trouble is wanted."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from rich.console import Console

    from printprep.types import Finding

WIDEST = 100


def stdout_console() -> Console:
    """A console that never guesses at markup or highlights, no wider than reads well."""
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    console.width = min(console.width, WIDEST)
    return console


def print_json(data: Mapping[str, Any]) -> None:
    """One JSON object on stdout."""
    from printprep.output.numbers import to_text

    click.echo(to_text(data))


def trouble_to_stderr(findings: Sequence[Finding]) -> None:
    """Warnings and errors, a line each, for -q."""
    for item in findings:
        if item.severity != "info":
            way_out = f" {item.fix}" if item.fix else ""
            click.echo(f"printprep: {item.severity}: {item.message}{way_out}", err=True)
