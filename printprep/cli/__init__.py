"""The command line, one thin file for each command.  ``main`` is the installed program."""

from __future__ import annotations

from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the program and exit with its exit code.

    From here on a signal ends the run in order; nothing is imported before.
    """
    from printprep.cli.supervise import supervised

    supervised(arguments)
