"""Films a simulated part: it is released on the bed, and the bed tilts until it falls."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.mesh.measure import bodies
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import MOST_LEAN_DEG, scene_of
from printprep.stand.stability import least_stable, stability
from printprep.stand.tilt_test import TIPS_ABOVE_DEG

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

# Seconds of rest, of tilting up to the share _CLOSE of the tilt angle, and of falling; beyond that
# share the bed tilts more slowly, by the factor _SLOWER.
_REST_S, _TILTING_S, _FALLING_S = 0.4, 2.4, 1.6
_CLOSE, _SLOWER = 0.9, 0.3


@dataclass(frozen=True, eq=False)
class Frame:
    """One moment of a film.

    lean_deg : of the bed;  rotation : (3, 3) and shift_mm : (3,) take a point of the part, in mm as
    it stood on the level bed, to its place over the bed now: rotation · point + shift.
    tilt_deg : how far the part has turned over, relative to the bed.
    """

    lean_deg: float
    rotation: Float
    shift_mm: Float
    tilt_deg: float


@dataclass(frozen=True, eq=False)
class Film:
    """The fall of the weakest body, frame by frame.

    body : as it stood at first, in mm;  azimuth_deg : toward which the bed leans.
    """

    body: Manifold
    azimuth_deg: float
    frames: tuple[Frame, ...]
    frames_per_s: float


def film(part: Manifold, first_layer_mm: float, frames_per_s: float) -> Film:
    """Film the weakest body: a moment of rest, the bed leaning more and more, and the fall.

    The bed leans toward the weakest edge (+x without contact), and stops when the foot leaves it.
    """
    each = bodies(part)
    standings = [stability(body, first_layer_mm) for body in each]
    standing = least_stable(standings)
    body = each[standings.index(standing)]
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
    """The present frame; ``centre_mm`` (3,) is the centre of mass at first."""
    rotation = motion.rotation
    shift = motion.position_mm - rotation @ centre_mm
    return Frame(lean_deg, rotation, shift, motion.tilt_deg)
