"""The fills: what the inside of a part is made of.

To add one, put a row into ``FILLS``; the command line, the Python interface and a batch find it
there.  The rows import what they need when they run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.grid.depth import Depths
    from printprep.pipeline.filled import Filled
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.progress import Stopwatch
    from printprep.types import Base, Lean, SlicerName, Solid


@dataclass(frozen=True)
class Fill:
    """One way to fill a part.

    summary : one line for --help.
    solid : whether the part prints as its mesh says, so that the mesh can be simulated.
    check : raises UsageError, before the long work, if profile or options do not go with the fill.
    check_output : raises UsageError for a suffix or a slicer whose file cannot carry the fill.
    run : decides the inside.
    estimate_mm3 : volume of material, estimated without a slicer; None where the profile does not
        allow the fill.
    """

    name: str
    summary: str
    solid: bool
    check: Callable[[Profile, FillOptions], None]
    check_output: Callable[[str, SlicerName], None]
    run: Callable[[Prepared, FillOptions, Lean, Stopwatch], Filled]
    estimate_mm3: Callable[[Solid, Depths, Profile, Base | None, Lean], float | None]


def _check_cavity(profile: Profile, options: FillOptions) -> None:
    from printprep.supports.policy import vault_choice

    vault_choice(options.vaults, profile)
    if options.slicer is not None:
        raise UsageError(
            "--slicer has no effect without --fill infill: it weighs prints with infill.",
            "Add --fill infill, or leave out --slicer.",
        )


def _any_output(suffix: str, slicer: SlicerName) -> None:
    del suffix, slicer


def _run_cavity(prepared: Prepared, options: FillOptions, lean: Lean, clock: Stopwatch) -> Filled:
    from printprep.pipeline.cavity import fill_with_cavity

    return fill_with_cavity(prepared, options, lean, clock)


def _estimate_cavity(
    solid: Solid, depths: Depths, profile: Profile, base: Base | None, lean: Lean
) -> float | None:
    from printprep.density.program import Program
    from printprep.infill.moment_field import moment_field_of

    interior = moment_field_of(depths, profile.wall_mm).interior(solid, depths)
    program = Program(solid.manifold, interior, profile)
    return program.solve(base, lean, profile.stability.lean_margin_deg).volume_mm3


def _check_infill(profile: Profile, options: FillOptions) -> None:
    from printprep.infill.options import check_infill

    check_infill(profile, objective=options.objective, vaults=options.vaults)


def _only_3mf(suffix: str, slicer: SlicerName) -> None:
    from printprep.output.limits import check_infill_output

    check_infill_output(suffix, slicer)


def _run_infill(prepared: Prepared, options: FillOptions, lean: Lean, clock: Stopwatch) -> Filled:
    from printprep.pipeline.infill import fill_with_infill

    return fill_with_infill(prepared, options, lean, clock)


def _estimate_infill(
    solid: Solid, depths: Depths, profile: Profile, base: Base | None, lean: Lean
) -> float | None:
    from printprep.infill.estimate import infill_program

    if profile.infill is None:
        return None
    program = infill_program(solid, depths, profile)
    return program.solve(base, lean, profile.stability.lean_margin_deg).volume_mm3


FILLS: dict[str, Fill] = {
    row.name: row
    for row in (
        Fill(
            name="cavity",
            summary="air",
            solid=True,
            check=_check_cavity,
            check_output=_any_output,
            run=_run_cavity,
            estimate_mm3=_estimate_cavity,
        ),
        Fill(
            name="infill",
            summary="the slicer's sparse infill, with dense ballast where weight is needed "
            "(filament and 3MF only)",
            solid=False,
            check=_check_infill,
            check_output=_only_3mf,
            run=_run_infill,
            estimate_mm3=_estimate_infill,
        ),
    )
}


def fill_of(name: str) -> Fill:
    """The fill with that name.  Raises UsageError, which lists the names."""
    found = FILLS.get(name)
    if found is None:
        raise UsageError(f"There is no fill {name}.", f"The fills are {', '.join(FILLS)}.")
    return found
