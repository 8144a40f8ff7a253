"""The film of a part: let go, and when it stays, the bed tilted until it tips."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies
from printprep.stand.motion import STEP_S, Motion
from printprep.stand.scene import MOST_LEAN_DEG, scene_of
from printprep.stand.simulate import STANDS_BELOW_DEG
from printprep.stand.stability import stability

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.types import Float

FRAMES_PER_S = 12.5  # a GIF counts in hundredths of a second
_STEPS = round(1 / (FRAMES_PER_S * STEP_S))
_REST_S, _TILTING_S, _FALLING_S = 0.4, 3.2, 1.4


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
    frames : FRAMES_PER_S of them a second.
    """

    body: Manifold
    azimuth_deg: float
    frames: tuple[Frame, ...]


def film(part: Manifold, first_layer_mm: float) -> Film:
    """Film the weakest body: a moment of rest, the bed leaning ever more, and its fall.

    The bed leans toward the weakest edge (+x without contact), evenly, so fast that the tilt angle
    comes after about three seconds.
    """
    each = [(body, stability(body, first_layer_mm)) for body in bodies(part)]
    body, standing = min(
        each, key=lambda pair: -np.inf if pair[1].tilt_deg is None else pair[1].tilt_deg
    )
    azimuth = standing.weakest_azimuth_deg or 0.0
    lean_per_frame = max(standing.tilt_deg or 0.0, 1.0) / (_TILTING_S * FRAMES_PER_S)
    scene = scene_of(body, first_layer_mm)
    motion = Motion(scene)
    frames = [motion_frame(motion, 0.0, scene.centre_mm)]
    lean, remaining = 0.0, round(_FALLING_S * FRAMES_PER_S)
    while remaining and lean < MOST_LEAN_DEG:
        fallen = frames[-1].tilt_deg >= STANDS_BELOW_DEG
        if fallen:
            remaining -= 1
        elif len(frames) > _REST_S * FRAMES_PER_S:
            lean += lean_per_frame
            motion.lean(lean, azimuth)
        motion.advance(_STEPS)
        frames.append(motion_frame(motion, lean, scene.centre_mm))
    return Film(body, azimuth, tuple(frames))


def motion_frame(motion: Motion, lean_deg: float, centre_mm: Float) -> Frame:
    """Where a body is now; ``centre_mm`` is its centre of mass as it stood."""
    rotation = motion.rotation
    shift = motion.position_mm - rotation @ centre_mm
    return Frame(lean_deg, rotation, shift, motion.tilt_deg)
