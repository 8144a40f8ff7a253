"""The ``printprep`` command.  Its subcommands are loaded by name when they are needed."""

from __future__ import annotations

import click

from printprep.cli.group import LazyGroup
from printprep.version import __version__

CONTEXT = {"help_option_names": ["-h", "--help"], "max_content_width": 80}

_COMMANDS = {
    "hollow": "printprep.cli.hollow",
    "batch": "printprep.cli.batch",
    "view": "printprep.cli.view",
    "report": "printprep.cli.report",
    "check": "printprep.cli.check",
    "explore": "printprep.cli.explore",
    "verify": "printprep.cli.verify",
    "hook": "printprep.cli.hook",
    "simulate": "printprep.cli.simulate",
    "evaluate": "printprep.cli.evaluate",
    "profiles": "printprep.cli.profiles",
    "completion": "printprep.cli.completion",
}

_EPILOG = """\b
Exit codes:
  0    done (there may be findings)
  1    a finding reached the --fail-on level
  2    usage: an invalid option, argument or profile key
  3    input: the file cannot be read, or is not accepted
  4    geometry: the model cannot be made into a solid
  5    output: the file cannot be written
  6    tool: a slicer is missing or failed
  70   a defect of printprep
  130  interrupted (Ctrl-C); 128 + N: ended by signal N

\b
Examples:
  printprep hollow model.stl -o out.3mf
  printprep check out.3mf --json
  printprep profiles show fdm-pla-0.4
"""


@click.group(
    cls=LazyGroup,
    lazy=_COMMANDS,
    invoke_without_command=True,
    context_settings=CONTEXT,
    epilog=_EPILOG,
)
@click.version_option(
    __version__, "--version", prog_name="printprep", message="%(prog)s %(version)s"
)
@click.pass_context
def printprep(ctx: click.Context) -> None:
    """Hollow a model for 3D printing.

    printprep makes the lightest part that still stands at the lean you choose and that your printer
    can print, and writes it to a file for your slicer.
    """
    if ctx.invoked_subcommand is None:
        click.echo(ctx.get_help())
