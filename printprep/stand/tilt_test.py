"""Tilt the bed slowly until the part tips, toward one azimuth after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies
from printprep.stand.directional import directional_tilt_deg
from printprep.stand.motion import Motion
from printprep.stand.scene import MOST_LEAN_DEG, Scene, scene_of
from printprep.stand.simulate import STANDS_BELOW_DEG
from printprep.stand.stability import stability
from printprep.types import Tipping

if TYPE_CHECKING:
    from manifold3d import Manifold

AZIMUTHS = 8

# A body past its tipping point falls as exp(t √(g/l)), some fifteen-fold in 0.2 s, so a bed that
# tilts at a rate r has tilted about 0.2 r degrees further by then.  A quick sweep brackets the
# angle, and a slow one from shortly before finds it to about a tenth of a degree.
_QUICK_DEG_S, _SLOW_DEG_S = 4.0, 0.5
_BACK_DEG = 2.0
_CONTROL_STEPS = 10
_CONTROL_S = 0.01
_SETTLE_S = 0.5


def tilt_test(
    part: Manifold, first_layer_mm: float, *, azimuths: int = AZIMUTHS
) -> tuple[Tipping, ...]:
    """The leans at which a part tips, simulated beside computed.

    Toward ``azimuths`` directions evenly around from +x, and toward the weakest edge's.  Of
    several bodies the first to tip counts.  Empty when a body has no contact with the bed.
    """
    each = bodies(part)
    standing = [stability(body, first_layer_mm) for body in each]
    weakest = min(standing, key=lambda one: -np.inf if one.tilt_deg is None else one.tilt_deg)
    if weakest.weakest_azimuth_deg is None:
        return ()
    scenes = [scene_of(body, first_layer_mm) for body in each]
    around = {360.0 * index / azimuths for index in range(azimuths)}
    tippings = []
    for azimuth in sorted(around | {weakest.weakest_azimuth_deg}):
        computed = [directional_tilt_deg(one, azimuth) for one in standing]
        simulated = [tipping_lean_deg(scene, azimuth) for scene in scenes]
        tippings.append(
            Tipping(
                azimuth_deg=azimuth,
                computed_deg=min(angle for angle in computed if angle is not None),
                simulated_deg=min(
                    (angle for angle in simulated if angle is not None), default=None
                ),
            )
        )
    return tuple(tippings)


def tipping_lean_deg(scene: Scene, azimuth_deg: float) -> float | None:
    """The lean toward an azimuth at which one body tips over in simulation.

    0 when it falls on the level bed already, None when it holds to MOST_LEAN_DEG.
    """
    motion = Motion(scene)
    motion.advance(round(_SETTLE_S / _CONTROL_S) * _CONTROL_STEPS)
    states = [(0.0, motion.state())]
    quick = _QUICK_DEG_S * _CONTROL_S
    for count in range(1, round(MOST_LEAN_DEG / quick) + 1):
        lean = count * quick
        if _tipped(motion, lean, azimuth_deg):
            break
        states.append((lean, motion.state()))
    else:
        return None
    start, state = states[max(0, len(states) - 1 - round(_BACK_DEG / quick))]
    motion.resume(state)
    slow = _SLOW_DEG_S * _CONTROL_S
    lean = start
    while lean < MOST_LEAN_DEG:
        if _tipped(motion, lean, azimuth_deg):
            return lean
        lean += slow
    return None


def _tipped(motion: Motion, lean_deg: float, azimuth_deg: float) -> bool:
    motion.lean(lean_deg, azimuth_deg)
    motion.advance(_CONTROL_STEPS)
    return motion.tilt_deg >= STANDS_BELOW_DEG
