"""The command line, one thin file for each command.  ``main`` is the installed program."""

from printprep.cli.run import main

__all__ = ["main"]
