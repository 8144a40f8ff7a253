"""Find the ballast: the program on what infill weighs, corrected by what the slicer deposits.

Sparse infill is the slicer's own affair, so where a slicer is at hand it is asked: once without
ballast, whose deposited moments replace the estimate, then with the ballast that these call for,
until the print stands at the lean.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import make_part
from printprep.density.outcome import density_of
from printprep.stand.contact import contact_of
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import balanced, least

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.density.program import BasePolicy, Choice, Program
    from printprep.infill.press import Press
    from printprep.types import Density, Lean, Part, Plane, Solid, Stability

    Float = NDArray[np.float64]

# A print that stands this much farther than it was solved for has ballast to spare.
SPARE_DEG = 0.3
# Out of reach, this near to what was solved for is near enough.
NEAR_DEG = 0.1
MOST_PRINTS = 5


@dataclass(frozen=True, eq=False)
class Filled:
    """A part with its ballast.

    moments : (4,) mm³ and mm⁴ of the whole print;  ballast_mm3 : what the ballast adds to it.
    """

    density: Density
    part: Part
    ballast: tuple[Manifold, ...]
    moments: Float
    ballast_mm3: float
    standing: Stability


def settle_estimated(solid: Solid, program: Program, choice: Choice, sparse: float) -> Filled:
    """A choice as it is weighed without a slicer; sparse : density of what is not filled."""
    moments = sum((part.moments for part in choice.parts), np.zeros(4))
    return _filled(solid, program, choice, sparse, moments, standing_of(program, choice))


def settle_weighed(
    solid: Solid, program: Program, policy: BasePolicy, lean: Lean, sparse: float, press: Press
) -> Filled | None:
    """The lightest filling found whose print stands at the lean, measured in its G-code.

    None where a G-code cannot tell: the bodies stand apart, which it prints as one, or nothing
    touches the bed.
    """
    choice = program.choose(policy, lean)
    if len(choice.parts) > 1 or choice.parts[0].solution is None:
        return None
    bare = press.weigh(make_part(solid, choice.base, ()), ())
    program = _corrected(program, bare.moments - program.unfilled(choice.base))
    margin = program.profile.stability.lean_margin_deg
    # With several bodies another base might leave them apart.
    one = len(program.bodies) == 1
    choice = program.choose(policy, lean) if one else program.solve(choice.base, lean, margin)
    best: Filled | None = None
    for _ in range(MOST_PRINTS):
        found, lost_deg = _printed(solid, program, choice, sparse, press, lean)
        best = found if best is None else _better(best, found, lean)
        aim, tilt = found.density.aim_deg, tilt_toward(found.standing, lean)
        if aim is None or tilt is None:
            break
        # Out of reach, the beads' loss cannot be made up for
        goal = lean.angle_deg if choice.reached == np.inf else aim - max(lost_deg, 0.0) - NEAR_DEG
        if tilt >= goal and not (found.ballast and tilt > aim + SPARE_DEG):
            break
        program = _corrected(program, found.moments - choice.parts[0].moments)
        choice = program.solve(choice.base, lean, max(margin + lost_deg, 0.0))
    return best


def ballast_of(program: Program, planes: Sequence[Plane | None]) -> tuple[Manifold, ...]:
    """The solids that print dense: each body below its plane."""
    below = [
        body.trim_by_plane([-value for value in plane.normal], -plane.offset_mm)
        for body, plane in zip(program.bodies, planes, strict=True)
        if plane is not None
    ]
    return tuple(solid for solid in below if not solid.is_empty())


def standing_of(program: Program, choice: Choice) -> Stability:
    """How a choice stands by its moments: its weakest body."""
    each = []
    for (_, section, _), part in zip(program.standing(choice.base), choice.parts, strict=True):
        x, y, z = (float(value) for value in part.moments[1:] / part.moments[0])
        each.append(balanced(contact_of(section), (x, y, z)))
    return least(each)


def _printed(
    solid: Solid, program: Program, choice: Choice, sparse: float, press: Press, lean: Lean
) -> tuple[Filled, float]:
    """A choice as printed, and by how many degrees its beads stand less than its section."""
    density = density_of(choice, program, sparse)
    part = make_part(solid, choice.base, ())
    weighed = press.weigh(part, ballast_of(program, density.planes))
    found = _filled(solid, program, choice, sparse, weighed.moments, weighed.standing)
    (_, section, _), *_ = program.standing(choice.base)
    by_section = tilt_toward(balanced(contact_of(section), weighed.centre_mm), lean)
    by_beads = tilt_toward(weighed.standing, lean)
    assert by_section is not None and by_beads is not None  # a choice with a solution has contact
    return found, by_section - by_beads


def _filled(
    solid: Solid,
    program: Program,
    choice: Choice,
    sparse: float,
    moments: Float,
    standing: Stability,
) -> Filled:
    density = density_of(choice, program, sparse)
    return Filled(
        density=density,
        part=make_part(solid, choice.base, ()),
        ballast=ballast_of(program, density.planes),
        moments=moments,
        ballast_mm3=max(float(moments[0] - program.unfilled(choice.base)[0]), 0.0),
        standing=standing,
    )


def _corrected(program: Program, difference: Float) -> Program:
    """The program with (4,) more on its bodies, which stand as one."""
    first, *others = program.moments
    return program.weighing([first + difference, *others])


def _better(first: Filled, second: Filled, lean: Lean) -> Filled:
    """The lighter of two that stand, else the one that stands farther."""
    tilts = [tilt_toward(found.standing, lean) for found in (first, second)]
    stands = [tilt is not None and tilt >= lean.angle_deg for tilt in tilts]
    if all(stands):
        return second if second.moments[0] < first.moments[0] else first
    return second if (tilts[1] or -np.inf) > (tilts[0] or -np.inf) else first
