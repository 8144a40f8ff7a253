"""The command line, one thin file for each command.  ``main`` is the installed program."""

from __future__ import annotations

from collections.abc import Sequence


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the program and exit with its exit code.

    arguments : those of the command line by default.  The program then runs in a process of its
    own, and a signal ends it in order; nothing is imported before.  Arguments that are given run
    in this process.
    """
    if arguments is not None:
        from printprep.cli.run import run

        raise SystemExit(run(arguments))
    from printprep.cli.supervise import supervised

    supervised(None)
