"""``printprep explore``: what each degree of lean costs."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from printprep.cli.options import (
    base_option,
    check_picture,
    json_option,
    model_argument,
    overrides,
    path_option,
    placement_of,
    placement_options,
    profile_option,
    resolution_option,
    set_option,
    vaults_option,
)
from printprep.pipeline.options import FillOptions

_EPILOG = """\b
Examples:
  printprep explore model.stl
  printprep explore scan.obj --up y --size 120 --chart curve.svg
  printprep explore figure.stl --base never --points 25 --json
"""


@click.command("explore", short_help="Show what each degree of lean costs.", epilog=_EPILOG)
@model_argument
@profile_option
@set_option
@placement_options
@resolution_option
@base_option
@vaults_option
@click.option(
    "--points",
    "count",
    type=int,
    default=13,
    show_default=True,
    metavar="COUNT",
    help="Number of leans to solve, evenly spaced from 0° to the largest that any filling reaches.",
)
@path_option(
    "--chart",
    metavar="OUT.svg|OUT.png",
    help="Draw the curve into this file.",
)
@json_option
@click.option("-q", "--quiet", is_flag=True, help="Print no progress on stderr.")
def command(
    model: Path,
    profile: str,
    settings: tuple[str, ...],
    resolution: int,
    base: Any,
    vaults: Any,
    count: int,
    chart: Path | None,
    as_json: bool,
    quiet: bool,
    **placement: Any,
) -> int:
    """Show the least mass of MODEL for every lean at which it can stand.

    Every point of the curve is the proven optimum of its own linear program, with the base that
    makes it lightest. For comparison, the solid, the shell alone and the part of DensiCrafter's
    objective are shown with mass and tilt angle.
    """
    from printprep.cli.console import print_json, stdout_console
    from printprep.pipeline.explore import explore
    from printprep.progress import for_terminal
    from printprep.report.chart import write_chart
    from printprep.report.exploration import exploration_json, show_exploration

    check_picture(chart, "chart", (".svg", ".png"))
    found = explore(
        model,
        profile=profile,
        overrides=overrides(settings),
        placement=placement_of(placement),
        options=FillOptions(resolution=resolution, base=base, vaults=vaults),
        count=count,
        progress=for_terminal(quiet=quiet),
    )
    if chart is not None:
        write_chart(found, chart)
    if as_json:
        print_json(exploration_json(found, model=str(model)))
    else:
        show_exploration(stdout_console(), found)
    return 0
