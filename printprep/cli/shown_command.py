"""The command line as a page repeats it: file names without their folders."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence

import click


def shown_command() -> str | None:
    """The command line of this run, None where it was not started as one."""
    context = click.get_current_context(silent=True)
    arguments = None if context is None else context.find_object(tuple)
    return None if arguments is None else without_folders(arguments)


def without_folders(arguments: Sequence[str]) -> str:
    """A command line that can be read and copied, without the paths of one machine."""
    return shlex.join(["printprep", *(_without_folder(argument) for argument in arguments)])


def _without_folder(argument: str) -> str:
    """A path's last part; "--option=PATH" keeps its option."""
    option, equals, value = argument.partition("=")
    if equals and option.startswith("--"):
        return f"{option}={_without_folder(value)}"
    last = re.split(r"[\\/]", argument.rstrip("\\/"))[-1]
    return last or argument
