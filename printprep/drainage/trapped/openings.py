"""Counts the ways out of enclosed spaces: through a single one, air and liquid get in each other's
way.

A way out is a patch where the cells of an enclosed space meet those of the air outside.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.trapped.cells import connected_pieces, spread_within
from printprep.drainage.trapped.pockets import enclosed_cells, pour_clearance

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool
    from printprep.drainage.trapped.clearance import Clearance

# Air passes where a ball of this share of a hole's width does.
PASSES = 0.5


@dataclass(frozen=True)
class Chamber:
    """An enclosed space with ways out.

    volume_mm3 : of it;  openings : how many ways out it has.
    widest_mm : width of the widest, as a circle of its area;  at_mm : (x, y, z) the middle of that.
    """

    volume_mm3: float
    openings: int
    widest_mm: float
    at_mm: tuple[float, float, float]


def chambers(
    part: Manifold, diameter_mm: float, *, space: Clearance | None = None
) -> tuple[Chamber, ...]:
    """The enclosed spaces of a part with at least one way out, the largest first.

    diameter_mm : of the drain holes, which decides how fine the grid is;  space : the part's
    ``pour_clearance`` for it, where it is at hand.
    """
    if part.is_empty():
        return ()
    space = pour_clearance(part, diameter_mm) if space is None else space
    if space.empty.all():  # thinner than a cell everywhere
        return ()
    radius = PASSES * diameter_mm / 2
    # To half a cell is enough for a ball half as wide as a hole.
    fits = space.clearance_mm >= radius
    inside = enclosed_cells(space, fits, radius)
    if not inside.any():
        return ()
    outside = fits & ~inside
    # Centres of balls stay a radius away from walls: the space itself is larger than theirs.
    number, _ = connected_pieces(inside, diagonal=True)
    room = spread_within(space.empty, np.where(outside, int(number.max()) + 1, number))
    pitch = space.grid.pitch_mm
    found = []
    for one in range(1, int(number.max()) + 1):
        mouth = outside & _beside(number == one)
        patches, _ = connected_pieces(mouth, diagonal=True)
        sizes = np.bincount(patches.ravel())[1:]
        if not len(sizes) or not sizes.any():
            continue
        largest = int(sizes.argmax()) + 1
        middle = np.argwhere(patches == largest).mean(axis=0)
        x, y, z = (space.grid.origin_mm + pitch * middle).tolist()
        # A way out is wider than the centres that pass through it, by a radius on each side.
        width = float(np.sqrt(sizes.max() * pitch**2 * 4 / np.pi)) + 2 * radius
        volume = float((room == one).sum()) * pitch**3
        found.append(Chamber(volume, int((sizes > 0).sum()), width, (x, y, z)))
    return tuple(sorted(found, key=lambda chamber: -chamber.volume_mm3))


def _beside(cells: Bool) -> Bool:
    """(nx, ny, nz) bool, the cells and their neighbours."""
    from scipy.ndimage import binary_dilation

    result: Bool = binary_dilation(cells, structure=np.ones((3, 3, 3)))
    return result
