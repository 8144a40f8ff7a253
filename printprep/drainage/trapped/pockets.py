"""The pour test: find what a ball as wide as the drain cannot leave.

Notation: r the ball's radius, "out" beyond the part's bounding box.

The test takes the cells where the ball's centre fits.  From every connected piece of them that does
not reach the outside, nothing runs out, however the part is turned.  The piece is *sealed* where no
passage leads out, and *narrow* where only passages below the ball's width do.  Smaller balls judge
a space too small for the ball: it is narrow where a ball of 0.6 r fits in and not even a ball of
0.36 r gets out.

From a piece that reaches the outside, liquid in a standing part runs out sideways and down.  Where
every way out rises, it stays as a *pool*, up to the lowest point of the passage over which it
spills, which lies r below the ball's centre.  A pool runs out once the part is turned.

A pool lies in the open, as in a mug, unless it belongs to a space at least twice as wide as its
widest passage out.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from printprep.drainage.trapped.cells import (
    cells_of_each,
    connected_pieces,
    edge_cells,
    spread_within,
)
from printprep.drainage.trapped.clearance import Clearance, space_around
from printprep.drainage.trapped.flood import basins
from printprep.grid.grid import block_around

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Bool, Int

    Int32 = NDArray[np.int32]

Kind = Literal["sealed", "narrow", "pool"]

# Cells along the ball's diameter, unless the part is too large for that.
CELLS_PER_BALL = 6.0
MOST_CELLS = 16e6
# For spaces too small for the ball: a ball that must fit in, and a ball that must get out, in r.
SMALL, SMALL_OUT = 0.6, 0.36
# The precision of the widest way out.
WAY_OUT_MM = 0.05
# A ladder of balls tells enclosed spaces from open ones: the factor between two balls, and how much
# wider than its way out an enclosed space is.
LADDER, ENCLOSED = 1.5, 2.0
# A pool is at least this deep, in cells: less may be the grid's own steps.
LEAST_CELLS = 2.0


@dataclass(frozen=True)
class Pocket:
    """A volume that does not run out.

    kind : "sealed" and "narrow" stay however the part is turned, a "pool" while it stands.
    volume_mm3 : what stays;  place_mm : (x, y, z) its lowest place.
    depth_mm : from that place to its highest.
    enclosed : True in a cavity; False in the open, as in a mug (pools only).
    way_out_mm : diameter of the widest ball that gets out, to 0.05 mm or half a cell; 0 where
        sealed, None for a pool.
    cavity : index of the given cavity it lies in, None outside all of them.
    """

    kind: Kind
    volume_mm3: float
    place_mm: tuple[float, float, float]
    depth_mm: float
    enclosed: bool
    way_out_mm: float | None
    cavity: int | None


def trapped(
    part: Manifold,
    diameter_mm: float,
    *,
    cavities: Sequence[Manifold] = (),
    pitch_mm: float | None = None,
    least_mm3: float | None = None,
    space: Clearance | None = None,
) -> tuple[Pocket, ...]:
    """Find the pockets of a part that drains through holes of a diameter, standing as it prints.

    Parameters
    ----------
    part : with its holes, z upward.
    diameter_mm : of the ball that must be able to leave.
    cavities : the part's cavities without holes, to tell which one a pocket lies in.
    pitch_mm : of the grid; by default a sixth of the diameter, or what 16 million cells allow.
    least_mm3 : smaller pockets do not count; by default the ball's own volume.
    space : the part's ``pour_clearance`` for the diameter, where it is at hand.

    Returns
    -------
    Sealed and narrow pockets, then pools; the largest of each first.
    """
    if part.is_empty():
        return ()
    least = np.pi / 6 * diameter_mm**3 if least_mm3 is None else least_mm3
    space = pour_clearance(part, diameter_mm, pitch_mm) if space is None else space
    if space.empty.all():  # thinner than a cell everywhere
        return ()
    fits = space.ball_fits(diameter_mm / 2)
    found = [*_closed(space, fits, diameter_mm / 2), *_pools(space, fits, diameter_mm / 2, least)]
    pockets = [_placed(pocket, space, cavities) for pocket in found]
    kept = [pocket for pocket in pockets if pocket.volume_mm3 >= least]
    return tuple(sorted(kept, key=lambda item: (item.kind == "pool", -item.volume_mm3)))


def pour_clearance(part: Manifold, diameter_mm: float, pitch_mm: float | None = None) -> Clearance:
    """The clearance on which a ball of a diameter is followed, with space for it all around."""
    if pitch_mm is None:
        low, high = np.reshape(part.bounding_box(), (2, 3))
        volume = float(np.prod(high - low + 2 * diameter_mm))
        pitch_mm = max(diameter_mm / CELLS_PER_BALL, (volume / MOST_CELLS) ** (1 / 3))
    margin = diameter_mm / 2 + 3 * pitch_mm
    return space_around(part, pitch_mm, margin)


@dataclass(frozen=True, eq=False)
class _Found:
    """The cells of a pocket: (n,) flat indices, and its figures."""

    kind: Kind
    cells: Int
    enclosed: bool
    way_out_mm: float | None


def _closed(space: Clearance, fits: Bool, radius_mm: float) -> list[_Found]:
    """Pockets that the ball cannot leave, whichever way the part is turned.

    fits : (nx, ny, nz) bool, cells where the ball's centre fits.
    """
    empty, outside = connected_pieces(space.empty, diagonal=False)
    large, large_free = connected_pieces(fits, diagonal=True)
    small, small_free = connected_pieces(space.clearance_mm >= SMALL * radius_mm, diagonal=True)
    way, way_free = connected_pieces(
        space.clearance_mm >= SMALL_OUT * radius_mm - space.grid.pitch_mm / 2, diagonal=True
    )
    closed = (large > 0) & (large != large_free)
    # Smaller spaces, where the ball is nowhere near.
    closed |= (small > 0) & (small != small_free) & (way != way_free)
    sealed = space.empty & (empty != outside)
    if not (closed.any() or sealed.any()):
        return []
    from scipy.ndimage import label

    seeds, count = label(closed | sealed, structure=np.ones((3, 3, 3)))
    seeds[large == large_free] = count + 1
    owner = spread_within(space.empty, seeds)
    found = []
    for _, cells in cells_of_each(owner, count):
        if sealed.flat[cells].all():
            found.append(_Found("sealed", cells, True, 0.0))
        else:
            way_out = _way_out_mm(space, cells, large == large_free, radius_mm)
            found.append(_Found("narrow", cells, True, way_out))
    return found


def _way_out_mm(space: Clearance, cells: Int, free: Bool, radius_mm: float) -> float:
    """Diameter of the widest ball that gets from a pocket to where the ball itself is free.

    cells : (n,) flat, of the pocket;  free : (nx, ny, nz) bool, where the ball itself gets out.
    """
    mine = np.zeros(free.shape, dtype=bool)
    mine.flat[cells] = True
    margin = int(np.ceil(2 * radius_mm / space.grid.pitch_mm)) + 4
    block = block_around(mine, margin)
    near, inside, out = space.within(block), mine[block], free[block]
    passes, stays = 0.0, radius_mm
    while stays - passes > WAY_OUT_MM / 2:
        middle = (passes + stays) / 2
        pieces, _ = connected_pieces(near.ball_fits(middle) | out, diagonal=True)
        if len(np.intersect1d(pieces[inside & (pieces > 0)], pieces[out])):
            passes = middle
        else:
            stays = middle
    return 2 * passes


def _pools(space: Clearance, fits: Bool, radius_mm: float, least_mm3: float) -> list[_Found]:
    """Pools: what stays in a standing part although a way leads out.

    fits : (nx, ny, nz) bool, cells where the ball's centre fits.
    """
    pitch = space.grid.pitch_mm
    flood = basins(fits, edge_cells(fits.shape), diagonal=True)
    deep = [
        number
        for number, spill in enumerate(flood.spill.tolist())
        if spill >= 0 and spill - flood.layer[flood.basin == number].min() >= LEAST_CELLS
    ]
    if not deep:
        return []
    renumbered = np.full(len(flood.spill) + 1, 0, dtype=np.int32)
    renumbered[deep] = np.arange(1, len(deep) + 1)
    seeds = renumbered[flood.basin][flood.pool]
    seeds[fits & (seeds == 0)] = len(deep) + 1
    owner = spread_within(space.empty, seeds)
    enclosed = None
    found = []
    for number, cells in cells_of_each(owner, len(deep)):
        # The liquid's surface lies at the lowest point of the passage.
        surface = flood.spill[deep[number - 1]] - radius_mm / pitch
        wet = cells[cells % fits.shape[2] < surface]
        if len(wet) * pitch**3 < least_mm3:
            continue
        if enclosed is None:
            enclosed = enclosed_cells(space, fits, radius_mm)
        centres = cells[fits.flat[cells]]
        found.append(_Found("pool", wet, _mostly(enclosed.flat[centres]), None))
    return found


def enclosed_cells(space: Clearance, fits: Bool, radius_mm: float) -> Bool:
    """(nx, ny, nz) bool, cells that belong to spaces wider than their ways out.

    fits : (nx, ny, nz) bool, cells where the ball's centre fits.
    """
    widest, radius = float(space.clearance_mm.max()), LADDER * radius_mm
    seeds, edge = np.zeros(fits.shape, dtype=np.int32), edge_cells(fits.shape)
    while ENCLOSED * radius <= widest:
        # Beyond the edge the space has no limit.
        pieces, free = connected_pieces((space.clearance_mm >= radius) | edge, diagonal=True)
        count = int(pieces.max())
        largest = np.zeros(count + 1, dtype=np.float32)
        inside = pieces > 0
        np.maximum.at(largest, pieces[inside], space.clearance_mm[inside])
        wide = largest >= ENCLOSED * radius
        wide[free] = False
        if wide.any():
            seeds[pieces == free] = 2
            seeds[wide[pieces]] = 1
        radius *= LADDER
    return np.asarray(spread_within(fits, seeds) == 1)


def _mostly(flags: Bool) -> bool:
    """Whether more than half of the flags (n,) are set."""
    return bool(2 * np.count_nonzero(flags) > len(flags))


def _placed(found: _Found, space: Clearance, cavities: Sequence[Manifold]) -> Pocket:
    """Measure a pocket, and find the cavity it lies in."""
    grid = space.grid
    index = np.stack(np.unravel_index(found.cells, grid.shape), axis=1)
    low, high = int(index[:, 2].min()), int(index[:, 2].max())
    lowest = found.cells[index[:, 2] == low]
    best = lowest[int(np.argmax(space.clearance_mm.flat[lowest]))]
    place = grid.origin_mm + grid.pitch_mm * np.array(np.unravel_index(best, grid.shape))
    x, y, z = place.tolist()
    cavity = _cavity_at(place, cavities)
    return Pocket(
        kind=found.kind,
        volume_mm3=len(found.cells) * grid.pitch_mm**3,
        place_mm=(x, y, z),
        depth_mm=(high - low + 1) * grid.pitch_mm,
        enclosed=found.enclosed or cavity is not None,
        way_out_mm=found.way_out_mm,
        cavity=cavity,
    )


def _cavity_at(place: np.ndarray, cavities: Sequence[Manifold]) -> int | None:
    """Index of the cavity that holds a place (3,) mm, or None."""
    from printprep.grid.distance import Surface

    for number, cavity in enumerate(cavities):
        if bool(Surface.of(cavity).contains(place[None])[0]):
            return number
    return None
