"""The findings of a simulation; they are made only where a simulation is requested."""

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
_FIX = "Give it a larger base or another pose (--up), or hollow it with printprep."


def simulation_findings(simulation: Simulation, lean: Lean) -> Iterator[Finding]:
    """Falls by itself, tips at less than the lean, or disagrees with the computed tilt angle."""
    settled = simulation.settled
    if not settled.stands:
        fall = (
            f"falls over: after {settled.seconds:g} s it has turned by {settled.rotation_deg:.1f}°"
        )
        yield finding(
            "simulated-fall",
            f"In simulation the part {fall if simulation.tippings else 'has no foot to stand on'}.",
            _FIX,
            value=settled.rotation_deg,
        )
    first = first_to_tip(simulation, lean.azimuth_deg)
    if settled.stands and first is not None and held_deg(first) < lean.angle_deg:
        yield finding(
            "simulated-tip",
            f"In simulation the part tips at {held_deg(first):.1f}° toward azimuth "
            f"{first.azimuth_deg:.0f}°; it should stand at {lean}.",
            _FIX,
            value=held_deg(first),
            limit=lean.angle_deg,
        )
    yield from disagreements(simulation)


def disagreements(simulation: Simulation) -> Iterator[Finding]:
    """The azimuth at which simulated and computed tilt angle differ most, if by over a degree."""
    if not simulation.tippings:
        return
    worst = max(simulation.tippings, key=gap_deg)
    if gap_deg(worst) > AGREES_WITHIN_DEG:
        yield finding(
            "simulation-disagrees",
            f"Toward azimuth {worst.azimuth_deg:.0f}° the part tips at {held_deg(worst):.1f}° in "
            f"simulation; the computed tilt angle is {worst.computed_deg:.1f}°.",
            "Rely on the smaller angle, and report the model to printprep.",
            value=gap_deg(worst),
            limit=AGREES_WITHIN_DEG,
        )


def first_to_tip(simulation: Simulation, toward_deg: float | None = None) -> Tipping | None:
    """The direction in which it tips first, or the one toward ``toward_deg``; None if none."""
    tippings = (
        item for item in simulation.tippings if toward_deg is None or item.azimuth_deg == toward_deg
    )
    return min(tippings, key=held_deg, default=None)


def held_deg(tipping: Tipping) -> float:
    """The lean up to which the whole foot stays on the bed, at most the largest one tried."""
    return MOST_LEAN_DEG if tipping.tips_deg is None else tipping.tips_deg


def gap_deg(tipping: Tipping) -> float:
    """Difference of simulated and computed tilt angle, both within the leans that are tried."""
    return abs(held_deg(tipping) - float(np.clip(tipping.computed_deg, 0.0, MOST_LEAN_DEG)))
