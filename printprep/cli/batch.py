"""``printprep batch``: many models, one row each."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import dry_run_option, fail_on_option, json_option, quiet_option
from printprep.cli.part_options import job_of, part_options
from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.batches.item import Item

_EPILOG = """\b
Examples:
  printprep batch models/ -o parts
  printprep batch 'scans/*.obj' -o parts --up y --size 120 --lean 15
  printprep batch orders.csv -o parts --resume
  printprep batch models/ -o parts --scheduler tcp://host:8786 --transfer

\b
A CSV has a column `file`, and any option above as a column:
  file,size,lean,profile
  bust.stl,120,15,resin-standard
"""


@click.command("batch", short_help="Hollow many models, on one machine or many.", epilog=_EPILOG)
@click.argument("inputs", nargs=-1, required=True, metavar="INPUTS...")
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    required=True,
    metavar="FOLDER",
    help="Folder for the parts, the journal and the summary. A folder given as input keeps its "
    "structure.",
)
@click.option(
    "--format",
    "suffix",
    type=click.Choice(("3mf", "stl", "obj", "ply")),
    default="3mf",
    show_default=True,
    help="Format of the parts; 3mf carries the print settings.",
)
@part_options
@click.option(
    "--plugs",
    is_flag=True,
    help="Also write plugs for the drain holes of each part, as PART-plugs.3mf.",
)
@click.option(
    "--reports",
    is_flag=True,
    help="Also write a page about each part, as PART.html, and summary.html with links to them.",
)
@click.option(
    "--jobs",
    "workers",
    type=click.IntRange(1),
    metavar="N",
    help="Models at once on this machine. Default: one a core, as far as memory allows.",
)
@click.option(
    "--memory",
    "memory_mib",
    type=click.FloatRange(min=0, min_open=True),
    metavar="MIB",
    help="Memory for all models at once. Default: most of what is free.",
)
@click.option(
    "--timeout",
    "timeout_s",
    type=click.FloatRange(min=0, min_open=True),
    metavar="SECONDS",
    help="End a model that takes longer; it becomes a row.",
)
@click.option(
    "--scheduler",
    metavar="ADDRESS",
    help="Run on this Dask cluster, for example tcp://host:8786.",
)
@click.option(
    "--transfer",
    is_flag=True,
    help="Send models to the workers and bring parts back. Without it, workers reach the same "
    "folders by the same paths.",
)
@click.option(
    "--resume",
    is_flag=True,
    help="Go on with an earlier batch: skip what is complete and unchanged.",
)
@dry_run_option
@fail_on_option("none", " Such a part is not written, and its row says so.")
@json_option
@quiet_option
def command(
    inputs: tuple[str, ...],
    output: Path,
    suffix: str,
    plugs: bool,
    reports: bool,
    workers: int | None,
    memory_mib: float | None,
    timeout_s: float | None,
    scheduler: str | None,
    transfer: bool,
    resume: bool,
    dry_run: bool,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    **options: Any,
) -> int:
    """Hollow many models: INPUTS are files, folders, patterns and CSV tables.

    Every model becomes a row of the journal in the folder, whatever happens to it, and a line of
    summary.csv and summary.json. All options, files and names are checked before the first model
    starts. The exit code is 0 if every row is a part, else 1.
    """
    from printprep.batches.cluster import connect
    from printprep.batches.item import with_plugs, with_report
    from printprep.batches.run import BatchOptions, dry_run_batch, plan, run_batch
    from printprep.batches.summary import write_summary
    from printprep.report.batch import follow

    for asked, what in ((plugs, "plugs"), (reports, "reports")):
        if asked and transfer:
            raise UsageError(
                f"--transfer brings back parts, not {what}.",
                f"Leave out --{what}, or use a shared folder.",
            )
    items = _items(inputs, options, output, f".{suffix}", fail_on)
    if plugs:
        items = [with_plugs(item) for item in items]
    if reports:
        items = [with_report(item) for item in items]
    if dry_run:
        from printprep.report.dry_run import follow_dry_run

        planned = plan(items, output, resume=resume, dry=True)
        return 1 if follow_dry_run(dry_run_batch(planned), as_json=as_json, quiet=quiet) else 0
    how = BatchOptions(workers, memory_mib, timeout_s, resume, transfer)
    client = None if scheduler is None else connect(scheduler)
    planned = plan(items, output, resume=resume)
    rows = follow(planned, run_batch(planned, how, client), as_json=as_json, quiet=quiet)
    write_summary(planned, rows)
    return 0 if all(row.status == "part" for row in rows) else 1


def _items(
    inputs: tuple[str, ...], options: dict[str, Any], folder: Path, suffix: str, fail_on: str
) -> list[Item]:
    """All models in the order they were named."""
    from printprep.batches.item import found_models, items_of
    from printprep.cli.batch_table import items_in

    template = job_of(options, model=Path(), output=Path(), plugs=None, fail_on=fail_on)
    items: list[Item] = []
    for given in inputs:
        if Path(given).suffix.lower() == ".csv":
            items += items_in(Path(given), options, folder, suffix, fail_on)
        else:
            items += items_of(found_models([given], folder), template, folder, suffix)
    return items
