"""What tests ask of the command lines that a page shows."""

from __future__ import annotations

import re
from pathlib import Path

import click

from printprep.cli.app import printprep


def unknown_options(words: list[str]) -> set[str]:
    """The options in a command line (without the program's name) that its command does not have.

    Raises AssertionError where there is no such command.
    """
    command: click.Command | None = printprep
    rest = list(words)
    while isinstance(command, click.Group) and rest:
        name = rest.pop(0)
        command = command.get_command(click.Context(command), name)
        assert command is not None, f"no command {name}"
    assert command is not None
    known = {option for item in command.params for option in item.opts}
    return {word for word in rest if re.match("--?[a-z]", word)} - known


def missing_targets(page: Path) -> list[str]:
    """The files that a page links to and that are not there."""
    targets = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8"))
    return [
        target for target in targets if "://" not in target and not (page.parent / target).exists()
    ]
