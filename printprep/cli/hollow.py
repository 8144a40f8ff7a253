"""``printprep hollow``: hollow a model and write the part."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.drains import drain_options
from printprep.cli.options import (
    base_option,
    model_argument,
    output_form_options,
    overrides,
    path_option,
    placement_of,
    placement_options,
    profile_options,
    resolution_option,
    self_support_option,
    severity_of,
    slicer_option,
)
from printprep.objectives import DEFAULT_OBJECTIVE, OBJECTIVES, Solver
from printprep.output.manual_settings import SLICERS
from printprep.pipeline.fills import FILLS
from printprep.pipeline.options import FillOptions

if TYPE_CHECKING:
    from printprep.pipeline.job import JobResult
    from printprep.types import SlicerName

_EPILOG = """\b
Examples:
  printprep hollow model.stl -o out.3mf
  printprep hollow scan.obj --up y --size 120 --lean 15
  printprep hollow figure.stl -p resin-standard --wall 2.5
  printprep hollow figure.stl --fill infill
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
@click.option(
    "--for",
    "written_for",
    type=click.Choice(SLICERS),
    default="prusa",
    show_default=True,
    help="Slicer to write for. PrusaSlicer and SuperSlicer take the print settings from the file. "
    "Other slicers take only the shape; the settings to enter by hand are listed.",
)
@profile_options
@placement_options
@click.option(
    "--pose",
    type=int,
    metavar="K",
    help="Put the model into its K-th steadiest stable pose; 1 is the steadiest.",
)
@resolution_option
@click.option(
    "--objective",
    type=click.Choice(tuple(OBJECTIVES)),
    default=DEFAULT_OBJECTIVE,
    show_default=True,
    help="What to optimize. "
    + ". ".join(f"{name}: {row.summary}" for name, row in OBJECTIVES.items())
    + ".",
)
@click.option(
    "--solver",
    "solver_name",
    type=click.Choice(tuple(dict.fromkeys(s for row in OBJECTIVES.values() for s in row.solvers))),
    default="plane",
    show_default=True,
    help="How --objective paper is solved. plane: exactly. adam: by gradient descent, as in the "
    "paper.",
)
@click.option(
    "--device",
    default="cpu",
    show_default=True,
    metavar="DEVICE",
    help="Device for --solver adam: cpu, cuda or cuda:N.",
)
@base_option
@click.option(
    "--simulate",
    is_flag=True,
    help="Also simulate the part: let it stand freely, then tilt the bed until it tips.",
)
@click.option(
    "--verify",
    "verify_it",
    is_flag=True,
    help="Also slice the part with PrusaSlicer and measure the G-code, like `printprep verify`.",
)
@self_support_option
@click.option(
    "--drains",
    "drain_count",
    type=click.IntRange(0, 16),
    metavar="N",
    help="Give every cavity at least N drain holes, one of them a vent. Default: the profile's "
    "number (2 in the profiles for resin and powder).",
)
@click.option(
    "--drain-diameter",
    "drain_diameter_mm",
    type=float,
    metavar="MM",
    help="Diameter of the drain holes (profile key drain.diameter_mm).",
)
@click.option("--no-drains", is_flag=True, help="Leave the cavities sealed.")
@path_option(
    "--plugs",
    metavar="OUT.3mf",
    help="Also write tapered plugs for the drain holes, each as its own object.",
)
@click.option(
    "--fill",
    type=click.Choice(tuple(FILLS)),
    default="cavity",
    show_default=True,
    help="What fills the part. "
    + ". ".join(f"{name}: {row.summary}" for name, row in FILLS.items())
    + ".",
)
@slicer_option(
    "PrusaSlicer that weighs prints with infill. Default: PRINTPREP_SLICER, or the one installed; "
    "without one the weight is estimated."
)
@output_form_options("none", " The part is then not written.")
def command(
    model: Path,
    output: Path | None,
    written_for: SlicerName,
    profile: str,
    settings: tuple[str, ...],
    wall_mm: float | None,
    lean: str | None,
    pose: int | None,
    solver_name: str,
    device: str,
    simulate: bool,
    verify_it: bool,
    drain_count: int | None,
    drain_diameter_mm: float | None,
    no_drains: bool,
    plugs: Path | None,
    slicer: Path | None,
    resolution: int,
    objective: str,
    base: Any,
    self_support: bool | None,
    fill: str,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **placement: Any,
) -> int:
    """Hollow MODEL (STL, OBJ, PLY, 3MF, GLB; or voxels: NPZ, NPY, PT) and write the part.

    The part is the lightest one that still stands at --lean, with no wall thinner than the
    profile's. Its outside is that of the model, except for a base under its feet where that saves
    material.
    """
    from printprep.pipeline.job import Job, run_job
    from printprep.progress import for_terminal

    job = Job(
        model=model,
        output=Path(f"{model.stem}-hollow.3mf") if output is None else output,
        profile=profile,
        overrides=overrides(
            settings, wall_mm, drain_options(drain_count, drain_diameter_mm, no_drains)
        ),
        placement=placement_of(placement, pose),
        options=FillOptions(
            fill=fill,
            lean=lean,
            resolution=resolution,
            objective=objective,
            solver=Solver(solver_name, device),
            base=base,
            self_support=self_support,
            slicer=slicer,
        ),
        written_for=written_for,
        plugs=plugs,
        simulate=simulate,
        verify=verify_it,
        fail_on=severity_of(fail_on),
    )
    done = run_job(job, for_terminal(quiet=quiet))
    _print(done, model, as_json=as_json, quiet=quiet, verbose=verbose)
    return 1 if done.stopped else 0


def _print(done: JobResult, model: Path, *, as_json: bool, quiet: bool, verbose: bool) -> None:
    from printprep.cli.console import print_json, stdout_console, trouble_to_stderr
    from printprep.report.json import result_json
    from printprep.report.terminal import show_result
    from printprep.report.verification import show_verified, verify_json

    output = None if done.written is None else str(done.written)
    if as_json:
        report = result_json(done.result, done.findings, model=str(model), output=output)
        if done.verified is not None:
            report["verified"] = verify_json(done.verified, part=output)
        print_json(report)
    elif quiet:
        trouble_to_stderr(done.findings)
    else:
        console = stdout_console()
        show_result(console, done.result, done.findings, output=output, verbose=verbose)
        if done.verified is not None:
            console.print()
            show_verified(console, done.verified, with_findings=False)
