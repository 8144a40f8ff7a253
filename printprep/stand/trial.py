"""Runs both simulations of a part: the release on the level bed, and the tilting bed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.stand.simulate import simulate
from printprep.stand.tilt_test import tilt_test
from printprep.types import Simulation

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.types import Lean


def trial(part: Manifold, first_layer_mm: float, lean: Lean) -> Simulation:
    """Release a part on the level bed, and tilt the bed until it tips; this takes some seconds.

    The bed tilts toward eight azimuths, the weakest edge's, and the lean's where it has one.
    """
    return Simulation(
        simulate(part, first_layer_mm),
        tilt_test(part, first_layer_mm, toward_deg=lean.azimuth_deg),
    )
