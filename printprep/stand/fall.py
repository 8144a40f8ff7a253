"""The film of a part: let go, and when it stays, the bed tilted until it tips."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import MOST_LEAN_DEG, scene_of
from printprep.stand.stability import stability
from printprep.stand.tilt_test import TIPS_ABOVE_DEG

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

# The bed takes so long to come close to the tilt angle, and goes on from there more slowly.
_REST_S, _TILTING_S, _FALLING_S = 0.4, 2.4, 1.6
_CLOSE, _SLOWER = 0.9, 0.3


@dataclass(frozen=True, eq=False)
class Frame:
    """One moment.

    lean_deg : of the bed;  rotation (3, 3) and shift_mm (3,) take a point of the part, in mm as it
    stood on the level bed, to where it is over the bed: rotation · point + shift.
    tilt_deg : how far it has turned over, relative to the bed.
    """

    lean_deg: float
    rotation: Float
    shift_mm: Float
    tilt_deg: float


@dataclass(frozen=True, eq=False)
class Film:
    """What happened to the weakest body.

    body : as it stood, in mm;  azimuth_deg : toward which the bed leans;
    frames : so many of them a second.
    """

    body: Manifold
    azimuth_deg: float
    frames: tuple[Frame, ...]
    frames_per_s: float


def film(part: Manifold, first_layer_mm: float, frames_per_s: float) -> Film:
    """Film the weakest body: a moment of rest, the bed leaning ever more, and its fall.

    The bed leans toward the weakest edge (+x without contact), and stops when its foot comes off.
    """
    each = [(body, stability(body, first_layer_mm)) for body in bodies(part)]
    body, standing = min(
        each, key=lambda pair: -np.inf if pair[1].tilt_deg is None else pair[1].tilt_deg
    )
    azimuth = standing.weakest_azimuth_deg or 0.0
    tilt_deg = max(standing.tilt_deg or 0.0, 1.0)
    quick = _CLOSE * tilt_deg / (_TILTING_S * frames_per_s)
    scene = scene_of(body, first_layer_mm)
    motion = Motion(scene)
    frames = [_frame(motion, 0.0, scene.centre_mm)]
    lean, remaining = 0.0, round(_FALLING_S * frames_per_s)
    while remaining and lean < MOST_LEAN_DEG:
        if frames[-1].tilt_deg >= TIPS_ABOVE_DEG:
            remaining -= 1
        elif len(frames) > _REST_S * frames_per_s:
            lean += quick if lean < _CLOSE * tilt_deg else quick * _SLOWER
            motion.lean(lean, azimuth)
        motion.advance(round(1 / (frames_per_s * STEP_S)))
        frames.append(_frame(motion, lean, scene.centre_mm))
    return Film(body, azimuth, tuple(frames), frames_per_s)


def _frame(motion: Motion, lean_deg: float, centre_mm: Float) -> Frame:
    """Where a body is now; ``centre_mm`` (3,) is its centre of mass as it stood."""
    rotation = motion.rotation
    shift = motion.position_mm - rotation @ centre_mm
    return Frame(lean_deg, rotation, shift, motion.tilt_deg)
