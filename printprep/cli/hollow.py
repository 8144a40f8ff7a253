"""``printprep hollow``: the main job."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.drains import check_drains, check_plugs_output, drain_options, plug_findings
from printprep.cli.options import (
    model_argument,
    output_form_options,
    overrides,
    placement_options,
    profile_options,
    self_support_option,
)
from printprep.errors import UsageError
from printprep.output.manual_settings import SLICERS

if TYPE_CHECKING:
    from printprep.progress import Progress
    from printprep.types import HollowResult, SlicerName
    from printprep.verify.run import Verified

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
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="Where to write: .3mf (carries the print settings), .stl, .obj or .ply; an existing file "
    "is replaced. Default: MODEL-hollow.3mf in the current folder.",
)
@click.option(
    "--for",
    "slicer",
    type=click.Choice(SLICERS),
    default="prusa",
    show_default=True,
    help="The slicer to write for. Only PrusaSlicer (and SuperSlicer) takes its settings from the "
    "file; for others it holds the shape alone, and what must be set by hand is said.",
)
@profile_options
@placement_options
@click.option(
    "--pose",
    type=int,
    metavar="K",
    help="Lay the model into its K-th steadiest stable pose, the steadiest being 1.",
)
@click.option(
    "--resolution",
    type=int,
    default=64,
    show_default=True,
    metavar="N",
    help="Voxels along the longest side, for the optimization; walls are exact at any.",
)
@click.option(
    "--objective",
    type=click.Choice(("lean", "paper")),
    default="lean",
    show_default=True,
    help="lean: the lightest part that stands at the lean. paper: DensiCrafter's weighted sum.",
)
@click.option(
    "--solver",
    type=click.Choice(("plane", "adam")),
    default="plane",
    show_default=True,
    help="Of the paper's objective: its exact plane, or Adam as the paper descends.",
)
@click.option(
    "--device", default="cpu", show_default=True, help="Where Adam runs: cpu, cuda or cuda:N."
)
@click.option(
    "--base",
    type=click.Choice(("auto", "never", "always")),
    default="auto",
    show_default=True,
    help="Whether feet may be seated and their footprint grown; auto: where it saves material.",
)
@click.option(
    "--simulate",
    is_flag=True,
    help="Let the part go in a physics engine too, and tilt the bed until it tips.",
)
@click.option(
    "--verify",
    "verify_it",
    is_flag=True,
    help="Slice the part with PrusaSlicer too, and measure the G-code, as `printprep verify` does.",
)
@self_support_option
@click.option(
    "--drains",
    "drain_count",
    type=click.IntRange(0, 16),
    metavar="N",
    help="Drain every cavity by N holes at least, one of them a vent. Default: the profile's, two "
    "for resin and powder.",
)
@click.option(
    "--drain-diameter",
    "drain_diameter_mm",
    type=float,
    metavar="MM",
    help="Diameter of the drains (key drain.diameter_mm).",
)
@click.option("--no-drains", is_flag=True, help="Leave cavities sealed.")
@click.option(
    "--plugs",
    type=click.Path(path_type=Path),
    metavar="OUT.3mf",
    help="Write tapered plugs for the drains too, each an object of its own.",
)
@click.option(
    "--fill",
    type=click.Choice(("cavity", "infill")),
    default="cavity",
    show_default=True,
    help="cavity: hollow. infill: the profile's sparse infill carries the ceilings, and what must "
    "weigh prints dense (filament and 3MF only).",
)
@click.option(
    "--slicer",
    "prusa_slicer",
    type=click.Path(path_type=Path),
    metavar="PATH",
    help="The PrusaSlicer that weighs prints with infill. Default: PRINTPREP_SLICER, else the one "
    "on this machine, else they are estimated.",
)
@output_form_options("none")
def command(
    model: Path,
    output: Path | None,
    slicer: SlicerName,
    profile: str,
    settings: tuple[str, ...],
    wall_mm: float | None,
    simulate: bool,
    verify_it: bool,
    drain_count: int | None,
    drain_diameter_mm: float | None,
    no_drains: bool,
    plugs: Path | None,
    prusa_slicer: Path | None,
    fail_on: str,
    as_json: bool,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> int:
    """Hollow MODEL (STL, OBJ, PLY, 3MF or GLB; or voxels, NPZ, NPY or PT) and write the part.

    The part is the lightest that still stands when leaned by --lean, with no wall thinner than the
    profile's. Its outside is the model's, but for a base under its feet where that saves material.
    With --fail-on, nothing is written when a finding is as severe.
    """
    from printprep.output.manual_settings import check_slicer
    from printprep.output.part_file import check_output, format_findings, write_part
    from printprep.output.plugs import write_plugs
    from printprep.pipeline.hollow import hollow
    from printprep.profiles import load_profile
    from printprep.progress import for_terminal

    target = Path(f"{model.stem}-hollow.3mf") if output is None else output
    check_output(target)
    _refuse_to_replace(model, target)
    progress = for_terminal(quiet=quiet)
    drains = drain_options(drain_count, drain_diameter_mm, no_drains)
    changed = overrides(settings, wall_mm, drains)
    loaded = load_profile(profile, changed)
    check_slicer(loaded, slicer)
    check_drains(loaded, drain_diameter_mm, plugs)
    if plugs is not None:
        check_plugs_output(plugs, target, model)
    if options["fill"] == "infill":
        _check_infill(target, slicer, simulate=simulate)
    if verify_it:
        from printprep.verify.unwritten import check_verifiable

        check_verifiable(target, profile, changed)
    result = hollow(
        model,
        profile=profile,
        overrides=changed,
        slicer=prusa_slicer,
        progress=progress,
        **options,
    )
    result = _with_findings(result, format_findings(result.profile, target, slicer))
    if plugs is not None:
        result = _with_findings(result, plug_findings(result.drainage, plugs))
    if simulate:
        with progress.stage("simulate"):
            result = _with_simulation(result)
    verified = _verified(result, progress) if verify_it else None
    # What one slicer makes of the part is told, but does not change the part's own file
    found = result if verified is None else _with_findings(result, verified.findings)
    stopped = _stopped(found, fail_on)
    if not stopped:
        with progress.stage("write"):
            write_part(result, target, slicer)
            if plugs is not None and result.drainage is not None and result.drainage.drains:
                write_plugs(result, plugs)
    written = None if stopped else target
    _say(found, model, written, verified, as_json=as_json, quiet=quiet, verbose=verbose)
    return 1 if stopped else 0


def _refuse_to_replace(model: Path, target: Path) -> None:
    if target.exists() and model.exists() and target.samefile(model):
        raise UsageError(
            f"{target} is the model itself and would be replaced.", "Name another --output."
        )


def _check_infill(target: Path, slicer: SlicerName, *, simulate: bool) -> None:
    from printprep.infill.options import check_infill_output

    check_infill_output(target.suffix, slicer)
    if simulate:
        raise UsageError(
            "The simulation takes the mesh for solid, which a print with infill is not.",
            "Leave out --simulate; --verify measures the tilt in the G-code.",
        )


def _with_findings(result: HollowResult, more: tuple[Any, ...]) -> HollowResult:
    from printprep.check.registry import sorted_findings

    return replace(result, findings=sorted_findings([*result.findings, *more]))


def _with_simulation(result: HollowResult) -> HollowResult:
    from printprep.check.simulated import disagreements
    from printprep.stand.trial import trial

    found = trial(result.part.manifold, result.profile.printer.first_layer_mm, result.lean)
    return _with_findings(replace(result, simulation=found), tuple(disagreements(found)))


def _verified(result: HollowResult, progress: Progress) -> Verified:
    from printprep.verify.unwritten import verify_result

    return verify_result(result, progress=progress)


def _stopped(result: HollowResult, fail_on: Any) -> bool:
    from printprep.check.registry import at_or_above

    return fail_on != "none" and bool(at_or_above(result.findings, fail_on))


def _say(
    result: HollowResult,
    model: Path,
    written: Path | None,
    verified: Verified | None,
    *,
    as_json: bool,
    quiet: bool,
    verbose: bool,
) -> None:
    from printprep.cli.console import stdout_console, trouble_to_stderr

    output = None if written is None else str(written)
    if as_json:
        from printprep.report.json import result_json, to_text

        said = result_json(result, model=str(model), output=output)
        if verified is not None:
            from printprep.report.verification import verify_json

            said["verified"] = verify_json(verified, part=output)
        click.echo(to_text(said))
    elif quiet:
        trouble_to_stderr(result.findings)
    else:
        from printprep.report.terminal import show_result

        console = stdout_console()
        show_result(console, result, output=output, verbose=verbose)
        if verified is not None:
            from printprep.report.verification import show_verified

            console.print()
            show_verified(console, verified, with_findings=False)
