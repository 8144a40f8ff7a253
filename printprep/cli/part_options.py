"""The options that decide a part: `hollow` has them, `batch` has them for every model."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from printprep.cli.drains import drain_options
from printprep.cli.options import (
    Command,
    base_option,
    max_memory_option,
    overrides,
    placement_of,
    placement_options,
    profile_options,
    resolution_option,
    severity_of,
    slicer_option,
    together,
    vaults_option,
    voids_option,
)
from printprep.objectives import DEFAULT_OBJECTIVE, OBJECTIVES, Solver
from printprep.output.manual_settings import SLICERS
from printprep.pipeline.fills import FILLS
from printprep.pipeline.options import FillOptions

if TYPE_CHECKING:
    from printprep.pipeline.job import Job

_SOLVERS = tuple(dict.fromkeys(s for row in OBJECTIVES.values() for s in row.solvers))
_PLACEMENT = ("plate", "item", "partial", "units", "up", "scale", "height_mm", "size_mm")


def part_options(command: Command) -> Command:
    """Everything that decides a part but the model, the files and how to report it."""
    return together(
        click.option(
            "--for",
            "written_for",
            type=click.Choice(SLICERS),
            default="prusa",
            show_default=True,
            help="Slicer to write for. prusa: PrusaSlicer and SuperSlicer. orca: OrcaSlicer and "
            "BambuStudio. These take the settings of the object and the support blocker from the "
            "file; others take only the shape. The settings to enter by hand are listed.",
        ),
        profile_options,
        placement_options,
        click.option(
            "--pose",
            type=int,
            metavar="K",
            help="Put the model into its K-th steadiest stable pose; 1 is the steadiest.",
        ),
        resolution_option,
        click.option(
            "--objective",
            type=click.Choice(tuple(OBJECTIVES)),
            default=DEFAULT_OBJECTIVE,
            show_default=True,
            help="What to optimize. "
            + ". ".join(f"{name}: {row.summary}" for name, row in OBJECTIVES.items())
            + ".",
        ),
        click.option(
            "--solver",
            "solver_name",
            type=click.Choice(
                tuple(dict.fromkeys(s for row in OBJECTIVES.values() for s in row.solvers))
            ),
            default="plane",
            show_default=True,
            help="How --objective paper is solved. plane: exactly. adam: by descent, as in "
            "the paper.",
        ),
        click.option(
            "--device",
            default="cpu",
            show_default=True,
            metavar="DEVICE",
            help="Device for --solver adam: cpu, cuda or cuda:N.",
        ),
        base_option,
        voids_option,
        click.option(
            "--simulate",
            is_flag=True,
            help="Also simulate the part: let it stand freely, then tilt the bed until it tips.",
        ),
        click.option(
            "--verify",
            "verify_it",
            is_flag=True,
            help="Also slice the part with PrusaSlicer and measure the G-code, like "
            "`printprep verify`.",
        ),
        vaults_option,
        click.option(
            "--drains",
            "drain_count",
            type=click.IntRange(0, 16),
            metavar="N",
            help="Give every cavity at least N drain holes, one of them a vent. Default: the "
            "profile's number (2 in the profiles for resin and powder).",
        ),
        click.option(
            "--drain-diameter",
            "drain_diameter_mm",
            type=float,
            metavar="MM",
            help="Diameter of the drain holes (profile key drain.diameter_mm).",
        ),
        click.option("--no-drains", is_flag=True, help="Leave the cavities sealed."),
        click.option(
            "--fill",
            type=click.Choice(tuple(FILLS)),
            default="cavity",
            show_default=True,
            help="What fills the part. "
            + ". ".join(f"{name}: {row.summary}" for name, row in FILLS.items())
            + ".",
        ),
        slicer_option(
            "PrusaSlicer that weighs prints with infill. Default: PRINTPREP_SLICER, or the one "
            "installed; without one the weight is estimated."
        ),
        max_memory_option,
    )(command)


def job_of(
    given: dict[str, Any], *, model: Path, output: Path, plugs: Path | None, fail_on: str
) -> Job:
    """The job that ``part_options`` were given for one model; takes its own from ``given``.

    Raises UsageError for options that contradict each other.
    """
    from printprep.pipeline.job import Job

    drains = drain_options(
        given["drain_count"], given["drain_diameter_mm"], no_drains=given["no_drains"]
    )
    return Job(
        model=model,
        output=output,
        profile=given["profile"],
        overrides=overrides(given["settings"], given["wall_mm"], drains),
        placement=placement_of({name: given[name] for name in _PLACEMENT}, given["pose"]),
        options=FillOptions(
            fill=given["fill"],
            lean=given["lean"],
            resolution=given["resolution"],
            objective=given["objective"],
            solver=Solver(given["solver_name"], given["device"]),
            base=given["base"],
            voids=given["voids"],
            vaults=given["vaults"],
            slicer=given["slicer"],
            max_memory_mib=given["max_memory_mib"],
        ),
        written_for=given["written_for"],
        plugs=plugs,
        simulate=given["simulate"],
        verify=given["verify_it"],
        fail_on=severity_of(fail_on),
    )
