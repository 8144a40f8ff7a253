"""The objectives: what the optimization of the interior minimizes, and the default one.

An objective defines the density of a solid (in mm, with walls, base and lean) and the density of a
generator's voxels.  To add one, put a row into ``OBJECTIVES``; the command line, the Python
interface and the generators find it there.  The rows import what they need when they run.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.density.program import Choice, Program
    from printprep.paper.domain import PaperDomain
    from printprep.paper.settings import PaperSettings
    from printprep.types import Density, Lean

DEFAULT_OBJECTIVE = "lean"
PLANE = "plane"


@dataclass(frozen=True)
class Solver:
    """How an objective is solved: "plane", exactly, or "adam", by descent on a torch device."""

    name: str = PLANE
    device: str = "cpu"


OnSolid = Callable[["Program", "Choice", "Lean", float, Solver], "Density"]
"""The density of a solid with the base of a choice, solved for a lean plus a margin in degrees."""

OnVoxels = Callable[["PaperDomain", float, "PaperSettings", Solver], "Float"]
"""(n, n, n) density in [0, 1] of a generator's voxels, axes x, y, z, for a lean in degrees."""


@dataclass(frozen=True)
class Objective:
    """One objective.

    summary : one line for --help.
    aims_at_lean : whether a larger margin makes its part stand farther, so that a part that falls
        short is solved again.
    on_solid, on_voxels : its two densities.
    solvers : names of its solvers, the default first.
    """

    name: str
    summary: str
    aims_at_lean: bool
    on_solid: OnSolid
    on_voxels: OnVoxels
    solvers: tuple[str, ...] = field(default=(PLANE,))


def check_solver(objective: Objective, solver: Solver) -> None:
    """Raise UsageError for a solver that the objective lacks, or a device that it does not use."""
    if solver.name not in objective.solvers:
        raise UsageError(
            f"The objective {objective.name} has no solver {solver.name}.",
            f"Its solvers are {', '.join(objective.solvers)}: leave out --solver, or change "
            "--objective.",
        )
    if solver.name == PLANE and solver.device != "cpu":
        raise UsageError(
            f"The solver plane runs only on the cpu, not on {solver.device}.",
            "Leave out --device, or use --objective paper --solver adam.",
        )


def _lean_on_solid(
    program: Program, choice: Choice, lean: Lean, margin_deg: float, solver: Solver
) -> Density:
    from printprep.density.outcome import density_of

    del solver
    return density_of(program.solve(choice.base, lean, margin_deg), program)


def _lean_on_voxels(
    domain: PaperDomain, lean_deg: float, settings: PaperSettings, solver: Solver
) -> Float:
    from printprep.paper.voxel_lean import footprints, leanest

    del settings, solver
    return leanest(domain, lean_deg, footprints(domain)).weight


def _paper_on_solid(
    program: Program, choice: Choice, lean: Lean, margin_deg: float, solver: Solver
) -> Density:
    from printprep.paper.on_solid import paper_density

    del lean, margin_deg
    return paper_density(program, choice.base, solver.name, solver.device)


def _paper_on_voxels(
    domain: PaperDomain, lean_deg: float, settings: PaperSettings, solver: Solver
) -> Float:
    del lean_deg
    if solver.name == PLANE:
        from printprep.paper.plane import solve_plane

        return solve_plane(domain, settings).smoothed
    from printprep.paper.adam import solve_adam

    return solve_adam(domain, settings, device=solver.device).smoothed


OBJECTIVES: dict[str, Objective] = {
    row.name: row
    for row in (
        Objective(
            name="lean",
            summary="the least mass that stands at --lean",
            aims_at_lean=True,
            on_solid=_lean_on_solid,
            on_voxels=_lean_on_voxels,
        ),
        Objective(
            name="paper",
            summary="the weighted sum of the DensiCrafter paper",
            aims_at_lean=False,
            on_solid=_paper_on_solid,
            on_voxels=_paper_on_voxels,
            solvers=(PLANE, "adam"),
        ),
    )
}


def objective_of(name: str) -> Objective:
    """The objective with that name.  Raises UsageError, which lists the names."""
    found = OBJECTIVES.get(name)
    if found is None:
        raise UsageError(
            f"There is no objective {name}.", f"The objectives are {', '.join(OBJECTIVES)}."
        )
    return found
