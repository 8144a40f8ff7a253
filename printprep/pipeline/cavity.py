"""Carve what was solved, weigh what was carved, and solve again where the surface lost some lean.

The program sees voxels, the slicer sees a surface: cut at the plane, without the pieces too small
to keep, simplified.  The part counts as standing only when that surface does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.carve import cavities_of, cut, make_part
from printprep.cavity.surface import isosurface
from printprep.density.outcome import PaperSolver, density_of, paper_density
from printprep.drainage.drainer import Drainer
from printprep.grid.distance import DepthField
from printprep.stand.lean import tilt_toward
from printprep.stand.stability import stability

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.density.program import Choice, Program
    from printprep.profiles import Profile
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


@dataclass(frozen=True, eq=False)
class Settled:
    """What was solved, what came of it, and how that stands and drains (None: not asked to)."""

    density: Density
    part: Part
    stability: Stability
    drainage: Drainage | None


def settle_lean(
    solid: Solid,
    hollowable_volume: Manifold,
    program: Program,
    choice: Choice,
    lean: Lean,
    drainer: Drainer | None = None,
) -> Settled:
    """The part of the lightest filling whose final surface stands at the lean.

    Where the lean is out of reach the part stands as far as the choice says.  Holes and what is
    filled for them are weighed: once they are known, the program is solved again with them.

    Parameters
    ----------
    hollowable_volume : all that may be cavity;  choice : base and first solution.
    """
    bodies, weighed = program.bodies, False
    margin = program.profile.stability.lean_margin_deg
    for _ in range(MOST_SOLVES):
        density = density_of(choice, program)
        part = carve(solid, choice.base, hollowable_volume, program.profile, bodies, density.planes)
        drainage = None
        if drainer is not None:
            part, drainage = drainer.drain(part)
        standing = stability(part.manifold, program.profile.printer.first_layer_mm)
        if drainer is not None and drainage and not weighed:
            weighed = True
            if drainer.taken_mm3 > 0:
                program = program.drilled(drainer.bores, hollowable_volume - drainer.filled)
                choice = program.solve(choice.base, lean, margin)
                continue
        tilt_deg = tilt_toward(standing, lean)
        if choice.reached < np.inf or tilt_deg is None or tilt_deg >= lean.angle_deg:
            break
        margin += lean.angle_deg - tilt_deg + SAFETY_DEG
        higher = program.solve(choice.base, lean, margin)
        if density_of(higher, program).aim_deg == density.aim_deg:
            break
        choice = higher
    return Settled(density, part, standing, drainage)


def settle_paper(
    solid: Solid,
    hollowable_volume: Manifold,
    program: Program,
    choice: Choice,
    solver: PaperSolver = "plane",
    device: str = "cpu",
    drainer: Drainer | None = None,
) -> Settled:
    """The part of the paper's objective, on the base that the lean program chose.

    The objective knows no lean: it stands as far as it stands.  One plane serves all bodies; where
    Adam leaves densities instead, the cavity is where they are below one half.
    """
    density = paper_density(program, choice, solver, device)
    if solver == "adam":
        hollowable_volume = hollowable_volume ^ _below_half(density, program.interior.domain)
    part = carve(
        solid, choice.base, hollowable_volume, program.profile, program.bodies, density.planes
    )
    drainage = None
    if drainer is not None:
        part, drainage = drainer.drain(part)
    standing = stability(part.manifold, program.profile.printer.first_layer_mm)
    return Settled(density, part, standing, drainage)


def _below_half(density: Density, domain: Domain) -> Manifold:
    """Where the free voxels' density is below one half, and walls do not count.

    Voxels that are not free take the density of the nearest that is: where the wall begins the
    room for cavities says, to far below a voxel.
    """
    from scipy.ndimage import distance_transform_edt

    free = domain.share > 0.5
    if not free.any():
        return isosurface(DepthField(domain.grid, np.full(domain.grid.shape, -1, np.float32)), 0.0)
    nearest = distance_transform_edt(~free, return_distances=False, return_indices=True)
    emptiness = (0.5 - density.rho[tuple(nearest)]).astype(np.float32)
    return isosurface(DepthField(domain.grid, emptiness), 0.0)


def carve(
    solid: Solid,
    base: Base | None,
    hollowable_volume: Manifold,
    profile: Profile,
    bodies: Sequence[Manifold],
    planes: Sequence[Plane | None],
) -> Part:
    """The part with its cavity above the planes, one for each body of the solid."""
    void = cut(hollowable_volume, bodies, planes)
    return make_part(solid, base, cavities_of(void, profile.min_feature_mm))
