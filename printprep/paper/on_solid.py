"""The paper's objective on the interior of a solid: walls and base in mm, its terms in voxels."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.domain import with_base
from printprep.types import Density

if TYPE_CHECKING:
    from printprep.density.program import Program
    from printprep.types import Base


def paper_density(
    program: Program, base: Base | None, solver: str = "plane", device: str = "cpu"
) -> Density:
    """The density of the paper's objective, on the voxels that the lean program has.

    solver : "plane", exact, or "adam", the paper's own descent on a torch ``device``, which leaves
    densities and no plane.

    Raises UsageError for a device that torch does not have.
    """
    from printprep.paper.domain import PaperDomain
    from printprep.paper.plane import solve_plane
    from printprep.paper.settings import PaperSettings

    interior = program.interior
    domain = interior.domain if base is None else with_base(interior.domain, base.manifold)
    frozen = domain.shell | domain.base
    free = domain.share > 0.5
    solid = frozen | domain.free
    ground = int(np.flatnonzero(solid.any(axis=(0, 1)))[0])
    nothing = np.zeros_like(free)
    voxels = PaperDomain(solid, solid & ~free, free, nothing, free, ground)
    settings = PaperSettings(resolution=max(domain.grid.shape))
    if solver == "adam":
        from printprep.paper.adam import solve_adam

        solution = solve_adam(voxels, settings, device=device)
        planes = None
    else:
        solution = solve_plane(voxels, settings)
        plane = None if solution.plane is None else solution.plane.in_mm(domain.grid)
        planes = (plane,) * len(program.bodies)
    return Density(
        rho=solution.smoothed,
        planes=planes,
        aim_deg=None,
        reachable_deg=None,
        certificate=None,
    )
