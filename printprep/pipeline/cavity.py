"""The cavity: base, density, and the surface that is cut from the hollowable volume.

The program sees voxels, the slicer sees a surface: cut at the plane, without the pieces too small
to keep, simplified.  The part counts as standing only when that surface stands, so where the
surface lost some lean the program is solved again.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import cavities_of, cut, make_part
from printprep.cavity.surface import isosurface
from printprep.drainage.drainer import Drainer
from printprep.grid.distance import DepthField
from printprep.objectives import objective_of
from printprep.pipeline.filled import Filled
from printprep.pipeline.hollowable import hollowable
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import stability

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.density.program import Choice, Program
    from printprep.objectives import Objective, Solver
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.progress import Stopwatch
    from printprep.types import (
        Base,
        Density,
        Domain,
        Drainage,
        Lean,
        Part,
        Plane,
        Solid,
        Stability,
    )

# A new solve aims higher by what was lost and this much more.
SAFETY_DEG = 0.02
MOST_SOLVES = 6


def fill_with_cavity(
    prepared: Prepared, options: FillOptions, lean: Lean, clock: Stopwatch
) -> Filled:
    """The lightest part that stands at the lean, hollow."""
    volume = hollowable(prepared, options, clock)
    with clock.stage("base"):
        program = volume.program(prepared.solid)
        choice = program.choose(options.base, lean)
    with clock.stage("solve"):
        solved = solve_and_carve(
            prepared.solid,
            volume.manifold,
            program,
            choice,
            lean,
            objective=objective_of(options.objective),
            solver=options.solver,
            drainer=Drainer(volume.profile) if volume.profile.drain.count else None,
        )
    return Filled(
        profile=volume.profile,
        depths=volume.depths,
        program=program,
        density=solved.density,
        part=solved.part,
        stability=solved.stability,
        volume_mm3=solved.part.manifold.volume(),
        supports=volume.supports,
        drainage=solved.drainage,
    )


@dataclass(frozen=True, eq=False)
class Carved:
    """A density, the part carved from it, how that stands and drains (None: no drains asked)."""

    density: Density
    part: Part
    stability: Stability
    drainage: Drainage | None


def solve_and_carve(
    solid: Solid,
    hollowable_volume: Manifold,
    program: Program,
    choice: Choice,
    lean: Lean,
    *,
    objective: Objective,
    solver: Solver,
    drainer: Drainer | None = None,
) -> Carved:
    """The part of an objective whose final surface stands at the lean, where the objective aims.

    Where the lean is out of reach the part stands as far as the density says.  Drain holes and
    what is filled for them are weighed: once they are known, the program is solved again with
    them.

    Parameters
    ----------
    hollowable_volume : all that may be cavity;  choice : the base, and its first solution.
    """
    profile, undrilled, holes_weighed = program.profile, program, False
    margin_deg = profile.stability.lean_margin_deg
    wanted = objective.on_solid(program, choice, lean, margin_deg, solver)
    for _ in range(MOST_SOLVES):
        density = wanted
        part = carve(solid, choice.base, hollowable_volume, undrilled, density)
        drainage = None
        if drainer is not None:
            part, drainage = drainer.drain(part)
        stands = stability(part.manifold, profile.printer.first_layer_mm)
        if not objective.aims_at_lean:
            break
        if drainer is not None and drainage and not holes_weighed:
            holes_weighed = True
            if drainer.taken_mm3 > 0:
                program = program.drilled(drainer.bores, hollowable_volume - drainer.filled)
                wanted = objective.on_solid(program, choice, lean, margin_deg, solver)
                continue
        tilt_deg = tilt_toward(stands, lean)
        out_of_reach = density.reachable_deg is not None
        if out_of_reach or tilt_deg is None or tilt_deg >= lean.angle_deg:
            break
        margin_deg += lean.angle_deg - tilt_deg + SAFETY_DEG
        wanted = objective.on_solid(program, choice, lean, margin_deg, solver)
        if wanted.aim_deg == density.aim_deg:
            break
    return Carved(density, part, stands, drainage)


def carve(
    solid: Solid,
    base: Base | None,
    hollowable_volume: Manifold,
    program: Program,
    density: Density,
) -> Part:
    """The part with its cavity where the density leaves it empty.

    program : the one that the solid was weighed in, before holes were drilled.
    """
    planes: Sequence[Plane | None] = density.planes or (None,) * len(program.bodies)
    if density.planes is None:
        hollowable_volume = hollowable_volume ^ _below_half(density, program.interior.domain)
    void = cut(hollowable_volume, program.bodies, planes)
    return make_part(solid, base, cavities_of(void, program.profile.min_feature_mm))


def _below_half(density: Density, domain: Domain) -> Manifold:
    """Where the free voxels' density is below one half, and walls do not count.

    Voxels that are not free take the density of the nearest free one: the hollowable volume says
    where the wall begins, far more finely than a voxel.
    """
    from scipy.ndimage import distance_transform_edt

    free = domain.share > 0.5
    if not free.any():
        return isosurface(DepthField(domain.grid, np.full(domain.grid.shape, -1, np.float32)), 0.0)
    nearest = distance_transform_edt(~free, return_distances=False, return_indices=True)
    emptiness = (0.5 - density.rho[tuple(nearest)]).astype(np.float32)
    return isosurface(DepthField(domain.grid, emptiness), 0.0)
