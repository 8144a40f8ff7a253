"""``printprep evaluate``: the tables of the DensiCrafter paper, for any models."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from printprep.cli.options import json_option, quiet_option, traceback_option
from printprep.wording import printable

METHODS = (
    "solid", "shell", "paper", "paper-no-base", "lean", "lean-no-base", "lean-full-base",
    "lean-at-paper-tilt",
)  # fmt: skip

_EPILOG = """\b
Examples:
  printprep evaluate models/ -o evaluation
  printprep evaluate catalogue.csv --set dev -o evaluation --ablations
  printprep evaluate models/ -o evaluation --methods paper,lean --lean 15
"""


@click.command("evaluate", short_help="Compare methods on many models.", epilog=_EPILOG)
@click.argument("source", type=click.Path(path_type=Path), metavar="FOLDER|CATALOGUE")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FOLDER",
    help="Folder for the tables, and under results/ one file for each model and method. A result "
    "that is there with the same settings is not computed again.",
)
@click.option(
    "--methods",
    "names",
    default=",".join(METHODS),
    show_default=True,
    metavar="NAME,...",
    help="The methods to compare.",
)
@click.option(
    "--ablations",
    is_flag=True,
    help="Add the paper's ablations: without each term, without smoothing, without the base B, "
    "and with other λ and ε.",
)
@click.option(
    "--lean",
    "lean_deg",
    type=float,
    default=10.0,
    show_default=True,
    metavar="DEG",
    help="Lean for the methods that need one.",
)
@click.option(
    "--solver",
    type=click.Choice(("plane", "adam")),
    default="plane",
    show_default=True,
    help="How the paper's objective is solved. plane: exactly. adam: by gradient descent, as its "
    "authors do.",
)
@click.option(
    "--resolution",
    type=click.IntRange(min=4),
    default=64,
    show_default=True,
    metavar="N",
    help="Voxels along the edge of the unit cube.",
)
@click.option(
    "--voxels",
    type=click.Choice(("surface", "centre")),
    default="surface",
    show_default=True,
    help="Which voxels the object has. surface: those that the surface passes through are the "
    "shell, as in the authors' code. centre: those with their centre inside; the outermost are the "
    "shell.",
)
@click.option(
    "--base-reach",
    type=click.Choice(("below", "within")),
    default="below",
    show_default=True,
    help="How far the base B reaches around the object. below: less than ε voxels, as the paper "
    "says. within: up to and including ε, as its code does.",
)
@click.option("--set", "subset", metavar="NAME", help="Use only the catalogue's rows of this set.")
@click.option(
    "--up",
    default="+z",
    show_default=True,
    metavar="AXIS",
    help="Axis that points up, where the catalogue names none.",
)
@click.option("--only", multiple=True, metavar="MODEL", help="Use only this model. Repeatable.")
@click.option("--limit", type=int, metavar="COUNT", help="Use only the first COUNT models.")
@click.option(
    "--workers",
    type=int,
    default=1,
    show_default=True,
    metavar="COUNT",
    help="Number of models to evaluate at once, each in its own process.",
)
@json_option
@quiet_option
@traceback_option
def command(
    source: Path,
    output: Path,
    names: str,
    ablations: bool,
    lean_deg: float,
    solver: Any,
    base_reach: Any,
    resolution: int,
    voxels: Any,
    workers: int,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **which: Any,
) -> int:
    """Compare methods on the models of a FOLDER or a CATALOGUE (a CSV with a column "file").

    The models are set up as in the DensiCrafter paper: N³ voxels, a shell one voxel thick, objects
    scaled to the unit cube, unit density. The tables hold mass, mass as a share of the solid, the
    share of parts that stand in simulation and how far they turn, tilt angle, F-score and Chamfer
    distance to the input, and seconds. They are written as table.csv, results.json and tables.md.
    """
    from printprep.cli.console import print_json
    from printprep.evaluate.cases import data_set
    from printprep.evaluate.methods import methods
    from printprep.evaluate.run import evaluate
    from printprep.evaluate.tables import as_json as tables_json
    from printprep.evaluate.tables import markdown, write_tables

    del verbose  # read where errors are reported
    chosen = methods(
        [name.strip() for name in names.split(",") if name.strip()],
        ablations=ablations,
        resolution=resolution,
        solver=solver,
        lean_deg=lean_deg,
        base_reach=base_reach,
    )
    models = data_set(source, **which)
    told = None if quiet or as_json else _tell
    found = evaluate(models, chosen, output, voxels=voxels, workers=workers, told=told)
    write_tables(found, output)
    if as_json:
        print_json(tables_json(found))
    elif not quiet:
        click.echo(markdown(found), nl=False)
    for name, error in found.failures:
        click.echo(printable(f"printprep: error: {name}: {error.message}"), err=True)
    return found.failures[0][1].exit_code if found.failures else 0


def _tell(name: str, done: int, total: int) -> None:
    click.echo(f"{done}/{total} {printable(name)}", err=True)
