"""Turns the solution of the linear programs into a density on the grid, with its certificate."""

from __future__ import annotations

import numpy as np

from printprep.density.program import Choice, Program
from printprep.types import Certificate, Density, Plane


def density_of(choice: Choice, program: Program, least: float = 0.0) -> Density:
    """The choice as an (nx, ny, nz) density on the grid, with one plane for each body of the solid.

    least : density of a free voxel that is not filled, 0 for a cavity.
    """
    domain = program.interior.domain
    count = len(program.bodies)
    planes: list[Plane | None] = [None] * count
    rho = np.ones(int(domain.free.sum()))
    for part in choice.parts:
        if part.solution is None:
            rho[part.voxels] = 0.0
            continue
        rho[part.voxels] = part.solution.filling.rho
        for cell in part.cells:
            planes[cell] = part.solution.plane
    grid = (domain.shell | domain.free | domain.base).astype(float)
    grid[domain.free] = 1.0 - domain.share[domain.free] * (1.0 - rho) * (1.0 - least)
    grams = program.profile.material.density_g_cm3 / 1000
    reached = choice.reached
    aims = [part.solution.aim_deg for part in choice.parts if part.solution is not None]
    return Density(
        rho=grid,
        planes=tuple(planes),
        aim_deg=min((aim for aim in aims if aim is not None), default=None),
        reachable_deg=None if reached == np.inf else max(reached, -90.0),
        certificate=Certificate(
            voxel_mass_g=choice.volume_mm3 * grams,
            bound_g=choice.bound_mm3 * grams,
            gap=(choice.volume_mm3 - choice.bound_mm3) / choice.volume_mm3,
        ),
    )
