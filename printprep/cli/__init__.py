"""The command line: one file a command, each thin.  ``main`` is the installed program."""

from printprep.cli.run import main

__all__ = ["main"]
