"""Where summaries and findings go: to stdout, and with -q warnings and errors to stderr."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import click

if TYPE_CHECKING:
    from rich.console import Console

    from printprep.types import Finding

WIDEST = 100


def stdout_console() -> Console:
    """A console without markup or highlighting, at most ``WIDEST`` columns wide."""
    from rich.console import Console

    console = Console(highlight=False, markup=False, emoji=False)
    console.width = min(console.width, WIDEST)
    return console


def print_json(data: Mapping[str, Any]) -> None:
    """Print one JSON object on stdout."""
    from printprep.output.numbers import to_text

    click.echo(to_text(data))


def trouble_to_stderr(findings: Sequence[Finding]) -> None:
    """Print warnings and errors on stderr, one line each, as -q asks for."""
    for item in findings:
        if item.severity != "info":
            fix = f" {item.fix}" if item.fix else ""
            click.echo(f"printprep: {item.severity}: {item.message}{fix}", err=True)
