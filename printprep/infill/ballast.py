"""Finds the ballast: solves the program with estimated infill, corrected by real prints.

Only the slicer knows what its infill weighs.  If there is one, the part is sliced without ballast,
and the moments of that print replace the estimate.  Then it is sliced with the ballast that follows
from them, until the print stands at the lean.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import make_part
from printprep.density.outcome import density_of
from printprep.mesh.measure import together
from printprep.stand.contact import contact_of
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import balanced, least_stable

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.density.program import BasePolicy, Choice, Program
    from printprep.infill.trial_print import TrialSlicer, Weighed
    from printprep.types import Density, Lean, Part, Solid, Stability


# A print that stands this much farther than it was solved for has more ballast than needed.
SPARE_DEG = 0.3
# Where the lean is out of reach, the print must come this close to what was solved for.
NEAR_DEG = 0.1
MOST_PRINTS = 5


@dataclass(frozen=True, eq=False)
class Ballasted:
    """A part with its ballast.

    moments : (4,) volume in mm³ and first moments x, y, z in mm⁴ of the whole print.
    ballast_mm3 : volume that the ballast adds.
    """

    density: Density
    part: Part
    ballast: tuple[Manifold, ...]
    moments: Float
    ballast_mm3: float
    stability: Stability


def estimated_ballast(solid: Solid, program: Program, choice: Choice, sparse: float) -> Ballasted:
    """The ballast of a choice, without a slicer.  sparse : density of what is not filled."""
    moments = sum((part.moments for part in choice.parts), np.zeros(4))
    return Ballasted(
        density=density_of(choice, program, sparse),
        part=make_part(solid, choice.base, ()),
        ballast=_ballast(program, choice),
        moments=moments,
        ballast_mm3=float(moments[0] - program.unfilled(choice.base).sum(axis=0)[0]),
        stability=stability_of_choice(program, choice),
    )


def weighed_ballast(
    solid: Solid,
    program: Program,
    policy: BasePolicy,
    lean: Lean,
    sparse: float,
    trial_slicer: TrialSlicer,
) -> Ballasted | None:
    """The lightest filling whose print stands at the lean, measured in its G-code.

    None if some body does not touch the bed: a slicer may refuse it.
    """
    choice = program.choose(policy, lean)
    if any(part.solution is None for part in choice.parts):
        return None
    bare = trial_slicer.weigh(make_part(solid, choice.base, ()), (), _apart(program, choice))
    program = _corrected(program, choice, bare.moments - program.unfilled(choice.base))
    unballasted = program
    margin = program.profile.stability.lean_margin_deg
    # With several bodies, another base could join them differently.
    single = len(program.bodies) == 1
    choice = program.choose(policy, lean) if single else program.solve(choice.base, lean, margin)
    best: Ballasted | None = None
    for _ in range(MOST_PRINTS):
        density, part = density_of(choice, program, sparse), make_part(solid, choice.base, ())
        ballast = _ballast(program, choice)
        printed = trial_slicer.weigh(part, ballast, _apart(program, choice))
        added_mm3 = (printed.moments - unballasted.unfilled(choice.base)).sum(axis=0)[0]
        ballasted = Ballasted(
            density=density,
            part=part,
            ballast=ballast,
            moments=printed.moments.sum(axis=0),
            ballast_mm3=float(added_mm3) if ballast else 0.0,
            stability=least_stable(printed.stabilities),
        )
        best = ballasted if best is None else _better(best, ballasted, lean)
        aim, tilt = density.aim_deg, tilt_toward(ballasted.stability, lean)
        if aim is None or tilt is None:
            break
        lost_deg = _by_sections(program, choice, printed, lean) - tilt
        # Out of reach, nothing makes up for what the beads lose against the section.
        goal = lean.angle_deg if choice.reached == np.inf else aim - max(lost_deg, 0.0) - NEAR_DEG
        if tilt >= goal and not (ballast and tilt > aim + SPARE_DEG):
            break
        computed = np.stack([part.moments for part in choice.parts])
        program = _corrected(program, choice, printed.moments - computed)
        choice = program.solve(choice.base, lean, max(margin + lost_deg, 0.0))
    return best


def stability_of_choice(program: Program, choice: Choice) -> Stability:
    """How the least stable body of a choice stands, by its moments."""
    each = []
    for (_, section, _), part in zip(
        program.bodies_on_base(choice.base), choice.parts, strict=True
    ):
        x, y, z = (float(value) for value in part.moments[1:] / part.moments[0])
        each.append(balanced(contact_of(section), (x, y, z)))
    return least_stable(each)


def _by_sections(program: Program, choice: Choice, printed: Weighed, lean: Lean) -> float:
    """The tilt angle of a print with the sections of its feet instead of their beads."""
    each = [
        balanced(contact_of(section), body.centre_of_mass_mm)
        for (_, section, _), body in zip(
            program.bodies_on_base(choice.base), printed.stabilities, strict=True
        )
    ]
    tilt = tilt_toward(least_stable(each), lean)
    assert tilt is not None  # a choice with a solution has contact
    return tilt


def _ballast(program: Program, choice: Choice) -> tuple[Manifold, ...]:
    """The solids that print dense: each body below its plane."""
    solids = []
    for part in choice.parts:
        plane = None if part.solution is None else part.solution.plane
        if plane is None:
            continue
        for cell in part.cells:
            body = program.bodies[cell]
            below = body.trim_by_plane([-value for value in plane.normal], -plane.offset_mm)
            if not below.is_empty():
                solids.append(below)
    return tuple(solids)


def _apart(program: Program, choice: Choice) -> tuple[Manifold, ...]:
    """The solids that stand by themselves, in the order of the choice's parts."""
    return tuple(together([program.bodies[cell] for cell in part.cells]) for part in choice.parts)


def _corrected(program: Program, choice: Choice, difference: Float) -> Program:
    """The program with moments added to each part of the choice.

    difference : (k, 4) mm³ and mm⁴, one row for each part; it goes to the part's first body.
    """
    moments = list(program.moments)
    for part, added in zip(choice.parts, difference, strict=True):
        moments[part.cells[0]] = moments[part.cells[0]] + added
    return program.weighing(moments)


def _better(first: Ballasted, second: Ballasted, lean: Lean) -> Ballasted:
    """The lighter one if both stand, else the one that stands farther."""
    tilts = [tilt_toward(ballasted.stability, lean) for ballasted in (first, second)]
    first_deg, second_deg = (-np.inf if tilt is None else tilt for tilt in tilts)
    if min(first_deg, second_deg) >= lean.angle_deg:
        return second if second.moments[0] < first.moments[0] else first
    return second if second_deg > first_deg else first
