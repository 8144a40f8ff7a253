"""What the way that was not taken would weigh: an estimate, on the same base, without a slicer."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.types import AlternativeFill

if TYPE_CHECKING:
    from printprep.grid.depth import Depths
    from printprep.profiles import Profile
    from printprep.types import Base, Fill, Lean, Solid


def alternative_fill(
    taken: Fill, solid: Solid, depths: Depths, profile: Profile, base: Base | None, lean: Lean
) -> AlternativeFill | None:
    """The other fill of a filament print; None where there is no choice.

    Supports inside a cavity are not counted.
    """
    from printprep.density.program import Program
    from printprep.infill.estimate import infill_program
    from printprep.infill.moment_field import moment_field_of

    if profile.infill is None:
        return None
    other: Fill
    if taken == "cavity":
        other, program = "infill", infill_program(solid, depths, profile)
    else:
        interior = moment_field_of(depths, profile.wall_mm).interior(solid, depths)
        other, program = "cavity", Program(solid.manifold, interior, profile)
    found = program.solve(base, lean, profile.stability.lean_margin_deg)
    return AlternativeFill(other, found.volume_mm3 * profile.material.density_g_cm3 / 1000)
