"""The cavity: base, density, and the surface that is cut from the hollowable volume.

The linear program works on voxels; the slicer gets a surface that is cut at the plane, without
pieces that are too small, and simplified.  The part stands only if it stands with that surface.
Where the surface costs some tilt angle, the program is solved again.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import cavities_of, cut, finished, rough_part
from printprep.cavity.surface import isosurface
from printprep.drainage.drainer import Drainer
from printprep.grid.distance import DepthField
from printprep.objectives import objective_of
from printprep.pipeline.filled import Filled
from printprep.pipeline.hollowable import hollowable
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import stability
from printprep.supports.blocker import without_bores

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

# A new solve adds to the margin what was lost, and this much more.
SAFETY_DEG = 0.02
MOST_SOLVES = 6


def fill_with_cavity(
    prepared: Prepared, options: FillOptions, lean: Lean, clock: Stopwatch
) -> Filled:
    """The lightest hollow part that stands at the lean."""
    volume = hollowable(prepared, options, clock)
    with clock.stage("base"):
        program = volume.program(prepared.solid)
        choice = program.choose(options.base, lean)
    with clock.stage("solve"):
        drainer = Drainer(volume.profile) if volume.profile.drain.count else None
        solved = solve_and_carve(
            prepared.solid,
            volume.manifold,
            program,
            choice,
            lean,
            objective=objective_of(options.objective),
            solver=options.solver,
            drainer=drainer,
        )
    blocker = volume.blocker
    if blocker is not None and drainer is not None:
        blocker = without_bores(blocker, drainer.bores, volume.profile)
    return Filled(
        profile=volume.profile,
        depths=volume.depths,
        program=program,
        density=solved.density,
        part=solved.part,
        stability=solved.stability,
        volume_mm3=solved.part.manifold.volume(),
        supports=volume.supports,
        blocker=blocker if solved.part.cavities else None,
        drainage=solved.drainage,
        deep=volume.deep,
        hollowable=volume.manifold,
    )


@dataclass(frozen=True, eq=False)
class Carved:
    """A density, the part carved from it, and how the part stands and drains.

    drainage : None where no drains are requested.
    """

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
    """The part of an objective, solved until its final surface stands at the lean.

    An objective that does not aim at the lean is solved once.  Where the lean is out of reach, the
    part stands as far as the density says.  Drain holes and filled floors count: once they are
    known, the program is solved again with them.

    Parameters
    ----------
    hollowable_volume : all that may be cavity;  choice : the base, and its first solution.
    drainer : None where no drains are requested.
    """
    profile, undrilled, holes_weighed = program.profile, program, False
    margin_deg = profile.stability.lean_margin_deg
    next_density = objective.on_solid(program, choice, lean, margin_deg, solver)
    for _ in range(MOST_SOLVES):
        density = next_density
        part = carve(solid, choice.base, hollowable_volume, undrilled, density)
        drainage = None
        if drainer is not None:
            part, drainage = drainer.drain(part)
            if objective.aims_at_lean and not holes_weighed:
                holes_weighed = True
                if drainer.taken_mm3 > 0:
                    program = program.drilled(drainer.bores, hollowable_volume - drainer.filled)
                    next_density = objective.on_solid(program, choice, lean, margin_deg, solver)
                    if next_density.planes is None or next_density.planes != density.planes:
                        continue
                    density = next_density  # the same cavities: their holes stay
        part = finished(part, profile.crumb_mm3)
        part_stability = stability(part.manifold, profile.printer.first_layer_mm)
        if not objective.aims_at_lean:
            # The proof holds only for the program that aims at the lean
            density = replace(density, certificate=None)
            break
        tilt_deg = tilt_toward(part_stability, lean)
        out_of_reach = density.reachable_deg is not None
        if out_of_reach or tilt_deg is None or tilt_deg >= lean.angle_deg:
            break
        margin_deg += lean.angle_deg - tilt_deg + SAFETY_DEG
        next_density = objective.on_solid(program, choice, lean, margin_deg, solver)
        if next_density.aim_deg == density.aim_deg:
            break
    return Carved(density, part, part_stability, drainage)


def carve(
    solid: Solid,
    base: Base | None,
    hollowable_volume: Manifold,
    program: Program,
    density: Density,
) -> Part:
    """The part with its cavity where the density is empty, not yet finished.

    program : the one for the solid without drain holes.
    """
    planes: Sequence[Plane | None] = density.planes or (None,) * len(program.bodies)
    if density.planes is None:
        hollowable_volume = hollowable_volume ^ _below_half(density, program.interior.domain)
    void = cut(hollowable_volume, program.bodies, planes)
    profile = program.profile
    return rough_part(solid, base, cavities_of(void, profile.min_feature_mm))


def _below_half(density: Density, domain: Domain) -> Manifold:
    """The solid where the density of free voxels is below one half.

    Other voxels take the density of the nearest free voxel: the hollowable volume bounds the wall,
    far more finely than a voxel does.
    """
    from scipy.ndimage import distance_transform_edt

    free = domain.share > 0.5
    if not free.any():
        return isosurface(DepthField(domain.grid, np.full(domain.grid.shape, -1, np.float32)), 0.0)
    nearest = distance_transform_edt(~free, return_distances=False, return_indices=True)
    emptiness = (0.5 - density.rho[tuple(nearest)]).astype(np.float32)
    return isosurface(DepthField(domain.grid, emptiness), 0.0)
