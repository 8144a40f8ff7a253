"""Simulates a bed that tilts slowly until the part tips, toward one azimuth after the other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies
from printprep.stand.directional import directional_tilt_deg
from printprep.stand.motion import Motion
from printprep.stand.scene import MOST_LEAN_DEG, Scene, scene_of
from printprep.stand.simulate import STANDS_BELOW_DEG
from printprep.stand.stability import least_stable, stability
from printprep.types import Tipping

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

AZIMUTHS = 8
# A body that has turned by this much against the bed does not come back; the bed gives way by far
# less.
TIPS_ABOVE_DEG = 1.0

# A body past its tipping point falls as exp(t √(g/l)), l the radius of gyration, so the bed tilts
# on for a few times √(l/g) before the fall shows.  The rates are degrees in the time √(l/g), so
# that the delay is the same angle for all sizes: a quick sweep brackets the tilt angle, and a slow
# one that starts shortly before finds it to about 0.2°.
_QUICK_DEG, _SLOW_DEG = 0.2, 0.025
_BACK_DEG = 2.0
_CONTROL_STEPS = 10
_CONTROL_S = 0.01
_SETTLE_S = 0.5


def tilt_test(
    part: Manifold,
    first_layer_mm: float,
    *,
    azimuths: int = AZIMUTHS,
    toward_deg: float | None = None,
) -> tuple[Tipping, ...]:
    """The leans at which a part tips, simulated and computed, toward several azimuths.

    These are ``azimuths`` even steps from +x, the weakest edge's azimuth, and ``toward_deg`` where
    it is given.  Of several bodies the first to tip counts.  Empty where a body has no contact with
    the bed.
    """
    each = bodies(part)
    standing = [stability(body, first_layer_mm) for body in each]
    weakest = least_stable(standing)
    if weakest.weakest_azimuth_deg is None:
        return ()
    scenes = [scene_of(body, first_layer_mm) for body in each]
    tippings = []
    named = [weakest.weakest_azimuth_deg, *([] if toward_deg is None else [toward_deg])]
    for azimuth in _around(azimuths, named):
        angles = [directional_tilt_deg(one, azimuth) for one in standing]
        least = min(angle for angle in angles if angle is not None)
        tips, falls = zip(*(tip(scene, azimuth) for scene in scenes), strict=True)
        tippings.append(Tipping(azimuth, least, _least(tips), _least(falls)))
    return tuple(tippings)


def tip(scene: Scene, azimuth_deg: float) -> tuple[float | None, float | None]:
    """The leans toward an azimuth at which a body's foot leaves the bed, and at which it falls.

    0 where that happens on the level bed, None where it does not happen up to MOST_LEAN_DEG.
    """
    motion = Motion(scene)
    motion.advance(round(_SETTLE_S / _CONTROL_S) * _CONTROL_STEPS)
    rate = float(np.sqrt(scene.gravity))
    quick = _Sweep(motion, azimuth_deg, _QUICK_DEG * rate, 0.0)
    slowly = _SLOW_DEG * rate
    tips = quick.until(TIPS_ABOVE_DEG)
    falls = quick.until(STANDS_BELOW_DEG)
    if tips is None:
        return None, None
    slow = quick.again_before(tips, slowly)
    tips = slow.until(TIPS_ABOVE_DEG)
    if falls is None:
        return tips, None
    if falls - slow.lean_deg > _BACK_DEG:  # another part of it came down and holds it for a while
        slow = quick.again_before(falls, slowly)
    return tips, slow.until(STANDS_BELOW_DEG)


class _Sweep:
    """A bed that tilts at an even rate toward one azimuth, starting at a lean."""

    def __init__(self, motion: Motion, azimuth_deg: float, rate_deg_s: float, lean: float) -> None:
        self._motion = motion
        self._azimuth_deg = azimuth_deg
        self._per_control = rate_deg_s * _CONTROL_S
        self._from_deg = lean
        self._states = [motion.state()]

    @property
    def lean_deg(self) -> float:
        """The present lean."""
        return self._from_deg + (len(self._states) - 1) * self._per_control

    def until(self, tilt_deg: float) -> float | None:
        """Tilt on until the body has turned by an angle; the lean then, None if it never does."""
        while self._motion.tilt_deg < tilt_deg:
            if self.lean_deg >= MOST_LEAN_DEG:
                return None
            self._motion.lean(self.lean_deg, self._azimuth_deg)
            self._motion.advance(_CONTROL_STEPS)
            self._states.append(self._motion.state())
        return self.lean_deg

    def again_before(self, lean_deg: float, rate_deg_s: float) -> _Sweep:
        """The same sweep at another rate, from its state shortly before a lean."""
        back = round((max(lean_deg - _BACK_DEG, 0.0) - self._from_deg) / self._per_control)
        self._motion.resume(self._states[back])
        start = self._from_deg + back * self._per_control
        return _Sweep(self._motion, self._azimuth_deg, rate_deg_s, start)


def _around(azimuths: int, named: Sequence[float]) -> list[float]:
    """Evenly spaced azimuths and those named, which replace any within a degree of them."""
    even = [360.0 * index / azimuths for index in range(azimuths)]
    others = [one for one in even if all(1.0 < (one - name) % 360.0 < 359.0 for name in named)]
    return sorted({*others, *named})


def _least(angles: Sequence[float | None]) -> float | None:
    return min((angle for angle in angles if angle is not None), default=None)
