"""Everything the physics engine is asked about a part."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.stand.simulate import simulate
from printprep.stand.tilt_test import tilt_test
from printprep.types import Simulation

if TYPE_CHECKING:
    from manifold3d import Manifold


def trial(part: Manifold, first_layer_mm: float) -> Simulation:
    """Let a part go on the level bed, and tilt the bed until it tips; some seconds of work."""
    return Simulation(simulate(part, first_layer_mm), tilt_test(part, first_layer_mm))
