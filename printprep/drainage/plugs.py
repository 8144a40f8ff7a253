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
    back = frame(np.array(drain.axis)).T
    piece = plug_in_place(drain, outside)
    upright = piece.transform(np.column_stack([back, -back @ np.array(drain.centre_mm)]))
    return upright.translate((0.0, 0.0, plug_length_mm(drain)))


def plug_length_mm(drain: Drain) -> float:
    """Length of a plug from its tip to the middle of the hole's mouth."""
    return min(drain.length_mm, LONGEST * drain.diameter_mm)


def plug_in_place(drain: Drain, outside: Manifold) -> Manifold:
    """The plug of a drain where it closes the hole.  outside : as for :func:`plug`."""
    radius = drain.diameter_mm / 2
    length = plug_length_mm(drain)
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
    axis, centre = np.array(drain.axis), np.array(drain.centre_mm)
    return max((placed(profile, centre, axis) ^ outside).decompose(), key=_volume)


def _volume(piece: Manifold) -> float:
    return float(piece.volume())
