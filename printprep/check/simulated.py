"""What a simulation found, as findings; made for those who ask for one, not a rule for all."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.stand.scene import MOST_LEAN_DEG
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.types import Lean, Simulation, Tipping

AGREES_WITHIN_DEG = 1.0
_FIX = "Give it a larger base, another pose (--up), or hollow it with printprep."


def simulation_findings(simulation: Simulation, lean: Lean) -> Iterator[Finding]:
    """Falling by itself, tipping before the lean asked for, and disagreement with the figures."""
    settled = simulation.settled
    if not settled.stands:
        yield finding(
            "simulated-fall",
            f"Let go in simulation it falls: after {settled.seconds:g} s it has turned by "
            f"{settled.rotation_deg:.1f}°.",
            _FIX,
            value=settled.rotation_deg,
        )
    first = first_to_tip(simulation, lean.azimuth_deg)
    if settled.stands and first is not None and held_deg(first) < lean.angle_deg:
        yield finding(
            "simulated-tip",
            f"In simulation its foot leaves the bed at a lean of {held_deg(first):.1f}° toward "
            f"azimuth {first.azimuth_deg:.0f}°; the lean asked for is {lean}.",
            _FIX,
            value=held_deg(first),
            limit=lean.angle_deg,
        )
    yield from disagreements(simulation)


def disagreements(simulation: Simulation) -> Iterator[Finding]:
    """Where simulated and computed tilt angle are more than a degree apart, the worst of them."""
    if not simulation.tippings:
        return
    worst = max(simulation.tippings, key=gap_deg)
    if gap_deg(worst) > AGREES_WITHIN_DEG:
        yield finding(
            "simulation-disagrees",
            f"Toward azimuth {worst.azimuth_deg:.0f}° its foot leaves the bed at "
            f"{held_deg(worst):.1f}° in simulation, {worst.computed_deg:.1f}° as computed.",
            "Trust the smaller of the two, and report the model.",
            value=gap_deg(worst),
            limit=AGREES_WITHIN_DEG,
        )


def first_to_tip(simulation: Simulation, toward_deg: float | None = None) -> Tipping | None:
    """The azimuth toward which it tips first, or the one that is named; None without contact."""
    asked = (
        item for item in simulation.tippings if toward_deg is None or item.azimuth_deg == toward_deg
    )
    return min(asked, key=held_deg, default=None)


def held_deg(tipping: Tipping) -> float:
    """Up to which lean its foot stayed on the bed."""
    return MOST_LEAN_DEG if tipping.tips_deg is None else tipping.tips_deg


def gap_deg(tipping: Tipping) -> float:
    """How far simulated and computed are apart, within what a simulation can show."""
    return abs(held_deg(tipping) - float(np.clip(tipping.computed_deg, 0.0, MOST_LEAN_DEG)))
