"""What sparse infill weighs before a slicer is asked: calibrated, in closed form.

The shell: what lies within a wall of the outside, the wall a share of the slicer's own.  (Lines
make it thick across and layers make it thick upward, so on a slope it is thinner than either.)
The infill: gyroid is a density; lightning is not, it hangs under ceilings, and weighs by their
area.  The figures are fits to G-code, see docs/infill.md.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.infill.keys import walls_mm
from printprep.mesh.measure import arrays

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.profile_schema import Infill
    from printprep.profiles import Profile

    Float = NDArray[np.float64]

# Fits to PrusaSlicer 2.5.0 at 15 % over eleven models (docs/infill.md).  The infill's figures hold
# what it causes too: solid layers where a ceiling begins on it.
SHELL_SHARE = 0.9
GYROID_SHARE = 1.28
LIGHTNING_MM = 1.75
LIGHTNING_BELOW_MM = 10.0


def shell_mm(profile: Profile) -> float:
    """The depth at which the slicer's infill begins, on the mean over all slopes."""
    return SHELL_SHARE * float(np.mean(walls_mm(profile)))


def sparse_share(infill: Infill) -> float:
    """Share of the room inside that an even infill fills; lightning is none."""
    return GYROID_SHARE * infill.density if infill.pattern == "gyroid" else 0.0


def hanging(room: Manifold, infill: Infill) -> Float:
    """(4,) moments of the infill that hangs under the ceilings of a room, mm³ and mm⁴."""
    if infill.pattern != "lightning" or room.is_empty():
        return np.zeros(4)
    area, (x, y, z) = ceilings(room)
    return LIGHTNING_MM * area * np.array([1.0, x, y, z - LIGHTNING_BELOW_MM])


def ceilings(room: Manifold) -> tuple[float, Float]:
    """Area in plan of all that faces a room from above, mm², and its middle (3,) mm.

    Each ceiling above another counts.
    """
    vertices, faces = arrays(room)
    corners = vertices[faces]
    a, b, c = corners[:, 0, :2], corners[:, 1, :2], corners[:, 2, :2]
    along, across = b - a, c - a
    area = np.maximum(along[:, 0] * across[:, 1] - along[:, 1] * across[:, 0], 0.0) / 2
    middle: Float = area @ corners.mean(axis=1) / area.sum()
    return float(area.sum()), middle
