"""Plugs for drain holes: tapered, flush with the part's outside, printed as separate pieces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.channel import frame, placed

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.types import Drain

# A plug is as wide as its hole at the mouth and narrower by this at its tip, so that it wedges.
TAPER_MM = 0.3
# A plug is no longer than this many diameters, nor than its hole.
LONGEST = 2.0


def plug(drain: Drain, outside: Manifold) -> Manifold:
    """The plug of a drain, upright with its tip on the plate z = 0, centred on x = y = 0.

    outside : the part without its cavities; its surface continues over the plug's outer end.
    """
    radius = drain.diameter_mm / 2
    length = min(drain.length_mm, LONGEST * drain.diameter_mm)
    beyond = 2 * drain.diameter_mm  # cut off by the outside
    profile = np.array(
        [
            [0.0, -length],
            [radius - TAPER_MM / 2, -length],
            [radius, 0.0],
            [radius, beyond],
            [0.0, beyond],
        ]
    )
    axis = np.array(drain.axis)
    centre = np.array(drain.centre_mm)
    piece = max((placed(profile, centre, axis) ^ outside).decompose(), key=_volume)
    back = frame(axis).T
    upright = piece.transform(np.column_stack([back, -back @ centre]))
    return upright.translate((0.0, 0.0, length))


def _volume(piece: Manifold) -> float:
    return float(piece.volume())
