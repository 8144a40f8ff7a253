"""``printprep explore``: what each degree of lean costs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import (
    DEFAULT_PROFILE,
    model_argument,
    placement_options,
    self_support_option,
)
from printprep.errors import OutputError, UsageError

if TYPE_CHECKING:
    from printprep.pipeline.explore import Exploration

_EPILOG = """\b
Examples:
  printprep explore model.stl
  printprep explore scan.obj --up y --size 120 --chart curve.svg
  printprep explore figure.stl --base never --points 25 --json
"""


@click.command("explore", short_help="Show what each degree of lean costs.", epilog=_EPILOG)
@model_argument
@click.option(
    "-p",
    "--profile",
    default=DEFAULT_PROFILE,
    show_default=True,
    metavar="NAME|FILE",
    help="Printer, material and limits: a name that `printprep profiles` lists, or a TOML file.",
)
@click.option(
    "--set",
    "settings",
    multiple=True,
    metavar="KEY=VALUE",
    help="Change a key of the profile. Repeatable.",
)
@placement_options
@click.option(
    "--resolution",
    type=int,
    default=64,
    show_default=True,
    metavar="N",
    help="Voxels along the longest side.",
)
@click.option(
    "--base",
    type=click.Choice(("auto", "never", "always")),
    default="auto",
    show_default=True,
    help="Whether feet may be seated and grown; chosen anew for every lean.",
)
@self_support_option
@click.option(
    "--points",
    "count",
    type=int,
    default=13,
    show_default=True,
    help="Leans to solve, evenly from 0° to the largest that can be reached.",
)
@click.option(
    "--chart",
    type=click.Path(path_type=Path),
    metavar="OUT.svg|OUT.png",
    help="Draw the curve.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object, errors too.")
@click.option("-q", "--quiet", is_flag=True, help="No progress on stderr.")
def command(
    model: Path,
    settings: tuple[str, ...],
    chart: Path | None,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> int:
    """Show the least mass of MODEL for every lean it can be made to stand.

    Every point of the curve is the optimum of its own linear program, on the base that makes it
    lightest, and has its proof. Beside it: the solid, the shell alone, and the part of
    DensiCrafter's objective, each with its mass and the lean at which it tips.
    """
    from printprep.cli.console import stdout_console
    from printprep.cli.options import overrides
    from printprep.pipeline.explore import explore
    from printprep.progress import for_terminal

    _check_chart(chart)
    progress = for_terminal(quiet=quiet)
    found = explore(model, overrides=overrides(settings, None), progress=progress, **options)
    if chart is not None:
        _draw(found, chart)
    if as_json:
        from printprep.report.exploration import exploration_json
        from printprep.report.json import to_text

        click.echo(to_text(exploration_json(found, model=str(model))))
    else:
        from printprep.report.exploration import show_exploration

        show_exploration(stdout_console(), found)
    return 0


def _check_chart(path: Path | None) -> None:
    """Find out before the long work whether a picture can be written."""
    if path is None:
        return
    if path.suffix.lower() not in (".svg", ".png"):
        raise UsageError(f"{path} is neither .svg nor .png.", "Name a chart by one of these.")
    if not path.parent.is_dir():
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} does not exist.",
            "Make the folder first, or name another one.",
        )


def _draw(found: Exploration, path: Path) -> None:
    from printprep.files import write_atomically
    from printprep.report.chart import chart

    drawing = chart(found)
    write_atomically(path, drawing.svg() if path.suffix.lower() == ".svg" else drawing.png())
