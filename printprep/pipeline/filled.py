"""What every fill returns: a part whose inside is decided, and what it was computed from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.profiles import Profile
    from printprep.types import Density, Drainage, Finding, Infill, Part, Stability, Supports


@dataclass(frozen=True, eq=False)
class Filled:
    """A part whose inside is decided.

    profile : the profile with the settings that the part needs.
    depths, program : what it was solved with.
    stability : how the part stands;  volume_mm3 : volume of the material that prints.
    supports, blocker, drainage, infill : None where the fill has none.
    findings : those that only the fill can make.
    """

    profile: Profile
    depths: Depths
    program: Program
    density: Density
    part: Part
    stability: Stability
    volume_mm3: float
    supports: Supports | None = None
    blocker: Manifold | None = None
    drainage: Drainage | None = None
    infill: Infill | None = None
    findings: tuple[Finding, ...] = ()
