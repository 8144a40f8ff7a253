"""``printprep evaluate``: the paper's tables on any models."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from printprep.cli.options import json_option

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


@click.command("evaluate", short_help="The paper's tables on a folder of models.", epilog=_EPILOG)
@click.argument("source", type=click.Path(path_type=Path), metavar="FOLDER|CATALOGUE")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FOLDER",
    help="Where the tables go, and under results/ one file for each model and method; what is "
    "there with the same settings is not computed again.",
)
@click.option(
    "--methods",
    "names",
    default=",".join(METHODS),
    show_default=True,
    metavar="NAME,...",
    help="What to compare.",
)
@click.option(
    "--ablations",
    is_flag=True,
    help="Also the paper's: without each term, without smoothing, without B, other λ and ε.",
)
@click.option(
    "--lean",
    "lean_deg",
    type=float,
    default=10.0,
    show_default=True,
    metavar="DEG",
    help="Lean of the methods that ask for one.",
)
@click.option(
    "--solver",
    type=click.Choice(("plane", "adam")),
    default="plane",
    show_default=True,
    help="Of the paper's objective. plane: exact. adam: as its authors run it.",
)
@click.option(
    "--resolution",
    type=click.IntRange(min=4),
    default=64,
    show_default=True,
    metavar="N",
    help="Voxels along the unit cube's edge.",
)
@click.option(
    "--voxels",
    type=click.Choice(("surface", "centre")),
    default="surface",
    show_default=True,
    help="surface: what the surface passes through is the shell, as in the authors' code. centre: "
    "voxels whose centre is inside, the outermost of them the shell.",
)
@click.option(
    "--base-reach",
    type=click.Choice(("below", "within")),
    default="below",
    show_default=True,
    help="How far B reaches around the object: below ε voxels, as the paper says, or up to and "
    "including ε, as its code does.",
)
@click.option("--set", "subset", metavar="NAME", help="Of a catalogue, the rows of this set.")
@click.option(
    "--up",
    default="+z",
    show_default=True,
    metavar="AXIS",
    help="Axis that is up, where no catalogue says.",
)
@click.option("--only", multiple=True, metavar="MODEL", help="This model alone. Repeatable.")
@click.option("--limit", type=int, metavar="COUNT", help="The first models alone.")
@click.option(
    "--workers",
    type=int,
    default=1,
    show_default=True,
    metavar="COUNT",
    help="Models evaluated at once, each in a process of its own.",
)
@json_option
@click.option("-q", "--quiet", is_flag=True, help="Say nothing but what went wrong.")
@click.option("-v", "--verbose", is_flag=True, help="The traceback of a defect.")
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
    """Compare methods on the models of a FOLDER, or of a CATALOGUE (CSV with a column file).

    In the paper's picture: N³ voxels, a shell one voxel thick, objects scaled to the unit cube at
    unit density. Mass, mass as a share of the solid, share that stands in simulation and how far
    it turns, tilt angle, F-score and Chamfer distance to the input, seconds. Written as table.csv,
    results.json and tables.md.
    """
    from printprep.evaluate.cases import data_set
    from printprep.evaluate.methods import methods
    from printprep.evaluate.run import evaluate
    from printprep.evaluate.tables import as_json as tables_json
    from printprep.evaluate.tables import markdown, write_tables

    del verbose  # the program's outermost boundary reads it from the arguments
    chosen = methods(
        [name.strip() for name in names.split(",") if name.strip()],
        ablations=ablations,
        resolution=resolution,
        solver=solver,
        lean_deg=lean_deg,
        base_reach=base_reach,
    )
    models = data_set(source, **which)
    silent = quiet or as_json
    told = None if silent else _tell
    found = evaluate(models, chosen, output, voxels=voxels, workers=workers, told=told)
    write_tables(found, output)
    if as_json:
        from printprep.output.numbers import to_text

        click.echo(to_text(tables_json(found)))
    elif not quiet:
        click.echo(markdown(found), nl=False)
    for name, error in found.failures:
        click.echo(f"printprep: error: {name}: {error.message}", err=True)
    return found.failures[0][1].exit_code if found.failures else 0


def _tell(name: str, done: int, total: int) -> None:
    click.echo(f"{done}/{total} {name}", err=True)
