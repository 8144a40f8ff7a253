"""Suction cups: spaces without air while a part prints layer by layer, hanging from the plate.

An empty region of layer i is a cup when no way leads from it to the outside through the layers up
to i; the plate closes what opens only to it.  Each peel of such a layer pulls against the vacuum in
the cup.  Air gets in through any passage that the grid resolves.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.drainage.trapped.clearance import empty_cells
from printprep.drainage.trapped.flood import basins
from printprep.grid.cell_distance import cell_distance

if TYPE_CHECKING:
    from manifold3d import Manifold

# Cells along the longest side, unless a pitch is given.
CELLS = 200
# A shallower dish lets the air in again after a few layers.
LEAST_DEEP_MM = 1.0


@dataclass(frozen=True)
class Cup:
    """A space that gets no air over some layers.

    from_mm, to_mm : heights at which it begins and at which it opens or ends.
    opens : False where it never opens: a sealed cavity.
    area_mm2 : area on which the peel acts, over a millimetre of height or more;
    volume_mm3 : what it holds.
    place_mm : (x, y, z) in its lowest layer, away from its sides: where a vent helps.
    """

    from_mm: float
    to_mm: float
    opens: bool
    area_mm2: float
    volume_mm3: float
    place_mm: tuple[float, float, float]


def suction_cups(
    part: Manifold, *, pitch_mm: float | None = None, least_mm2: float = 10.0
) -> tuple[Cup, ...]:
    """Find the cups of a part that prints from its lowest point upward, the widest first.

    Parameters
    ----------
    part : in printing position, z upward from the plate.
    pitch_mm : of the grid, by default a two-hundredth of the longest side; the grid misses narrower
        walls and vents.
    least_mm2 : cups that are narrower, or have this area over less than a millimetre of height,
        do not count.
    """
    if part.is_empty():
        return ()
    box = np.reshape(part.bounding_box(), (2, 3))
    pitch = pitch_mm or float((box[1] - box[0]).max()) / CELLS
    grid, empty = empty_cells(part, pitch, 2 * pitch, 0.0)
    outside = np.zeros(grid.shape, dtype=bool)
    outside[[0, -1]] = outside[:, [0, -1]] = outside[:, :, -1] = True
    found = basins(empty, outside, diagonal=False)
    origin = grid.origin_mm
    cells = np.bincount(found.pool.ravel(), minlength=len(found.layer))
    lasting = max(2, round(LEAST_DEEP_MM / pitch))
    cups = []
    for number, spill in enumerate(found.spill.tolist()):
        pools = np.flatnonzero(found.basin == number)
        layers = found.layer[pools]
        per_layer = np.bincount(layers, weights=cells[pools])
        if np.count_nonzero(per_layer) < lasting:
            continue
        area = float(np.sort(per_layer)[-lasting]) * pitch**2
        if area < least_mm2:
            continue
        low = int(layers.min())
        high = int(layers.max()) + 1 if spill < 0 else spill
        floor = pools[layers == low]
        i, j = np.nonzero(np.isin(found.pool[:, :, low], floor))
        x, y = _innermost(i, j)
        floor_mm = origin[2] + (low - 0.5) * pitch
        cups.append(
            Cup(
                from_mm=float(floor_mm),
                to_mm=float(floor_mm + (high - low) * pitch),
                opens=spill >= 0,
                area_mm2=area,
                volume_mm3=float(per_layer.sum()) * pitch**3,
                place_mm=(
                    float(origin[0] + x * pitch),
                    float(origin[1] + y * pitch),
                    float(origin[2] + low * pitch),
                ),
            )
        )
    return tuple(sorted(cups, key=lambda cup: -cup.area_mm2))


def _innermost(i: np.ndarray, j: np.ndarray) -> tuple[int, int]:
    """The cell of a set that lies farthest from all cells not in it.

    i, j : (n,) indices of the set's cells.
    """
    low = np.array([i.min(), j.min()])
    mask = np.zeros((int(np.ptp(i)) + 3, int(np.ptp(j)) + 3), dtype=bool)
    mask[i - low[0] + 1, j - low[1] + 1] = True
    depth = cell_distance(mask)
    x, y = np.unravel_index(int(depth.argmax()), mask.shape)
    return int(x + low[0] - 1), int(y + low[1] - 1)
