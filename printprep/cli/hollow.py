"""``printprep hollow``: hollow a model and write the part."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.options import (
    dry_run_option,
    model_argument,
    output_form_options,
    path_option,
)
from printprep.cli.part_options import job_of, part_options

if TYPE_CHECKING:
    from printprep.pipeline.job import Job, JobResult
    from printprep.progress import Progress

_EPILOG = """\b
Examples:
  printprep hollow model.stl -o out.3mf
  printprep hollow scan.obj --up y --size 120 --lean 15
  printprep hollow figure.stl -p resin-standard --wall 2.5
  printprep hollow figure.stl --fill infill
  printprep hollow figure.stl --report figure.html
  printprep hollow vase.stl --set printer.layer_height_mm=0.3 --json
"""


@click.command("hollow", short_help="Hollow a model and write the part.", epilog=_EPILOG)
@model_argument
@path_option(
    "-o",
    "--output",
    metavar="FILE",
    help="File to write: .3mf (which carries the print settings), .stl, .obj or .ply. An existing "
    "file is replaced. Default: MODEL-hollow.3mf in the current folder.",
)
@part_options
@path_option(
    "--plugs",
    metavar="OUT.3mf",
    help="Also write tapered plugs for the drain holes, each as its own object.",
)
@path_option(
    "--report",
    metavar="OUT.html",
    help="Also write a page about the part: one file that shows it in three dimensions, opened "
    "along any plane, with all figures and findings. It needs no network.",
)
@dry_run_option
@output_form_options("none", " The part is then not written.")
def command(
    model: Path,
    output: Path | None,
    plugs: Path | None,
    report: Path | None,
    dry_run: bool,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> int:
    """Hollow MODEL (STL, OBJ, PLY, 3MF, GLB; or voxels: NPZ, NPY, PT) and write the part.

    The part is the lightest one that still stands at --lean, with no wall thinner than the
    profile's. Its outside is that of the model, except for a base under its feet where that saves
    material.
    """
    from printprep.cli.shown_command import shown_command
    from printprep.page.write import write_report
    from printprep.pipeline.job import run_job
    from printprep.progress import for_terminal

    target = Path(f"{model.stem}-hollow.3mf") if output is None else output
    job = job_of(options, model=model, output=target, plugs=plugs, fail_on=fail_on)
    job = replace(job, report=report)
    progress = for_terminal(quiet=quiet)
    if dry_run:
        _print_dry_run(job, progress, as_json=as_json, quiet=quiet)
        return 0
    done = run_job(job, progress)
    if report is not None:
        with progress.stage("page"):
            write_report(done, job, shown_command())
    _print(done, job, report, as_json=as_json, quiet=quiet, verbose=verbose)
    return 1 if done.stopped else 0


def _print_dry_run(job: Job, progress: Progress, *, as_json: bool, quiet: bool) -> None:
    from printprep.cli.console import print_json, stdout_console
    from printprep.pipeline.dry_run import dry_run
    from printprep.report.dry_run import dry_run_json, show_dry_run

    planned = dry_run(job, progress)
    if as_json:
        print_json(dry_run_json(planned))
    elif not quiet:
        show_dry_run(stdout_console(), planned)


def _print(
    done: JobResult,
    job: Job,
    report: Path | None,
    *,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> None:
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.report.json import result_json
    from printprep.report.terminal import show_result
    from printprep.report.verification import show_verified, verify_json

    output = None if done.written is None else str(done.written)
    report_file = None if report is None else str(report)
    if as_json:
        data = result_json(done.result, done.findings, model=str(job.model), output=output)
        if done.verified is not None:
            data["verified"] = verify_json(done.verified, part=output)
        if report_file is not None:
            data["report"] = report_file
        print_json(data)
    elif quiet:
        trouble_to_stderr(done.findings)
    else:
        console = stdout_console()
        show_result(
            console,
            done.result,
            done.findings,
            output=output,
            written_for=job.written_for,
            verbose=verbose,
        )
        if done.verified is not None:
            console.print()
            show_verified(console, done.verified, with_findings=False)
        if report_file is not None:
            console.print(f"The page about it: {report_file}", soft_wrap=True)
