"""Estimates the mass of sparse infill without a slicer, by calibrated closed forms.

The shell is what lies within a wall of the outside; that wall is a share of the slicer's.  (The
slicer's wall has lines sideways and layers upward; on a slope it is thinner than either.)  Gyroid
infill has a density.  Lightning infill has none: it hangs under ceilings and weighs in proportion
to their area.  The figures are fits to G-code, see docs/infill.md.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.output.prusa_keys import walls_mm

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.profile_schema import InfillSettings
    from printprep.profiles import Profile
    from printprep.types import Solid


# Fits to PrusaSlicer 2.5.0 at 15 % over eleven models (docs/infill.md).  The figures for infill
# include the solid layers where a ceiling begins on it.
SHELL_SHARE = 0.9
GYROID_SHARE = 1.28
LIGHTNING_MM = 1.75
LIGHTNING_BELOW_MM = 10.0


# The interior is only weighed, not cut, so it need not be as smooth as a cavity.
CELLS_PER_WALL = 2.0


def measured_depths(solid: Solid, profile: Profile, resolution: int) -> Depths:
    """Depths below a solid's surface, with a fine grid where its infill begins.

    resolution : voxels along the longest side.
    """
    from printprep.grid.depth import measure_depths

    return measure_depths(
        solid,
        resolution=resolution,
        wall_mm=shell_mm(profile),
        min_feature_mm=profile.min_feature_mm,
        margin_mm=profile.stability.base_growth_max_mm,
        cells_per_wall=CELLS_PER_WALL,
    )


def shell_mm(profile: Profile) -> float:
    """The depth in mm at which the slicer's infill begins, averaged over all slopes."""
    return SHELL_SHARE * float(np.mean(walls_mm(profile)))


def sparse_share(infill: InfillSettings) -> float:
    """Share of the interior that a uniform infill fills; 0 for lightning, which is not uniform."""
    return GYROID_SHARE * infill.density if infill.pattern == "gyroid" else 0.0


def hanging(ceiling: Float, infill: InfillSettings) -> Float:
    """The infill that hangs under ceilings: (4,) volume in mm³ and first moments in mm⁴.

    ceiling : (4,) area of the ceilings in plan view in mm², and its first moments in mm³.
    """
    if infill.pattern != "lightning":
        return np.zeros(4)
    lower = np.array([0.0, 0.0, 0.0, LIGHTNING_BELOW_MM * ceiling[0]])
    result: Float = LIGHTNING_MM * (ceiling - lower)
    return result


def infill_program(solid: Solid, depths: Depths, profile: Profile) -> Program:
    """The linear programs of a solid that is printed with the profile's infill.

    A filled voxel adds the difference between dense and sparse infill.
    """
    from printprep.density.program import Program
    from printprep.infill.moment_field import moment_field_of

    assert profile.infill is not None  # see :func:`printprep.infill.options.check_infill`
    moment_field = moment_field_of(depths, shell_mm(profile))
    interior = moment_field.interior(solid, depths)
    dense = replace(interior, moments=interior.moments * (1.0 - sparse_share(profile.infill)))
    program = Program(solid.manifold, dense, profile)
    body = interior.domain.body
    ceilings = [
        moment_field.ceiling[:, body == number].sum(axis=1) for number in range(len(program.bodies))
    ]
    return program.weighing(
        [
            whole + hanging(ceiling, profile.infill)
            for whole, ceiling in zip(program.moments, ceilings, strict=True)
        ]
    )
