"""A drilled channel: its inner end, its mouth, and its solid."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

# Sides of a channel's section; its flats, not its corners, are the diameter apart.
SEGMENTS = 64
# Rings of the ball at a channel's inner end.
RINGS = 12


@dataclass(frozen=True, eq=False)
class Channel:
    """A straight round channel from inside a cavity into the air.

    inner_mm : (3,) mm, centre of the ball at its inner end, which fits in the cavity.
    axis : (3,) unit vector, outward;  diameter_mm : between opposite flats.
    mouth_mm : along the axis from the inner end to the outside;  end_mm : to where the drill stops.
    length_mm : length of the axis in material.
    low_mm : height of its lowest point, at mouth or inner end.
    """

    inner_mm: Float
    axis: Float
    diameter_mm: float
    mouth_mm: float
    end_mm: float
    length_mm: float
    low_mm: float

    @property
    def centre_mm(self) -> Float:
        """(3,) mm, the middle of the mouth, on the part's outside."""
        return self.inner_mm + self.mouth_mm * self.axis

    @property
    def floor_mm(self) -> float:
        """Height of the lowest point of the ball at its inner end."""
        return float(self.inner_mm[2]) - self.diameter_mm / 2


def bored(channel: Channel) -> Manifold:
    """The solid that the drill removes, rounded at its inner end."""
    radius = channel.diameter_mm / 2 / np.cos(np.pi / SEGMENTS)
    angle = np.linspace(-np.pi / 2, 0, RINGS + 1)
    profile = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    profile[0, 0] = 0.0
    corners = np.vstack([profile, [[radius, channel.end_mm], [0.0, channel.end_mm]]])
    return placed(corners, channel.inner_mm, channel.axis)


def placed(profile: Float, origin_mm: Float, axis: Float) -> Manifold:
    """A solid of revolution about an axis through a point.

    profile : (n, 2) mm, radius and position along the axis;  origin_mm : (3,) mm;  axis : (3,).
    """
    from manifold3d import CrossSection

    upright = CrossSection([profile]).revolve(SEGMENTS)
    return upright.transform(np.column_stack([frame(axis), origin_mm]))


def frame(axis: Float) -> Float:
    """(3, 3) a right-handed frame whose third column is the axis (3,)."""
    aside = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(aside, axis)
    first /= np.linalg.norm(first)
    return np.column_stack([first, np.cross(axis, first), axis])
