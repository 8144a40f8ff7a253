"""The least mass for every lean on one base, with the margin that parts are solved with."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.pipeline.explore import MOST_DEG, Point
from printprep.types import Lean

if TYPE_CHECKING:
    from printprep.density.program import Choice, Program
    from printprep.types import Base


def mass_over_lean(
    program: Program, base: Base | None, azimuth_deg: float | None, count: int = 11
) -> tuple[Point, ...]:
    """The lightest filling at ``count`` leans from 0° to the largest that any filling reaches.

    base : that of all of them; another one may be lighter at another lean (see ``explore``).
    Empty where no filling stands.
    """
    margin_deg = program.profile.stability.lean_margin_deg

    def solved(lean_deg: float) -> Choice:
        return program.solve(base, Lean(lean_deg, azimuth_deg), margin_deg)

    reachable = min(solved(MOST_DEG).reached - margin_deg, MOST_DEG)
    if reachable <= 0:
        return ()
    grams = program.profile.material.density_g_cm3 / 1000
    growth_mm = None if base is None else base.growth_mm
    leans = np.linspace(0.0, 0.99 * reachable, count)
    return tuple(
        Point(
            lean_deg=float(lean),
            mass_g=choice.volume_mm3 * grams,
            growth_mm=growth_mm,
            gap=(choice.volume_mm3 - choice.bound_mm3) / choice.volume_mm3,
        )
        for lean in leans
        for choice in [solved(float(lean))]
    )
