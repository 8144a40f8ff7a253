"""What every fill returns: a part whose inside is decided, and how it came about."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.profiles import Profile
    from printprep.types import Density, Drainage, Finding, Infill, Part, Stability, Supports


@dataclass(frozen=True, eq=False)
class Filled:
    """A part whose inside is decided.

    profile : with the settings that the part needs;  depths, program : it was solved with.
    stability : how the part stands;  volume_mm3 : of the material that prints.
    supports, drainage, infill : None where the fill has none.
    findings : what only the fill knows.
    """

    profile: Profile
    depths: Depths
    program: Program
    density: Density
    part: Part
    stability: Stability
    volume_mm3: float
    supports: Supports | None = None
    drainage: Drainage | None = None
    infill: Infill | None = None
    findings: tuple[Finding, ...] = ()
