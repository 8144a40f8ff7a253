"""The pour test: what a ball as wide as the drain cannot leave.

Notation: r the ball's radius, "out" beyond the part's bounding box.

Cells that hold a place for the ball's centre are its room.  From every piece of that room that is
not connected with the outside nothing runs out, however the part is turned: it is *sealed* where
no passage at all leads out, and *narrow* where only passages below the ball's width do.  A space
too small for the ball is judged by smaller ones: it is narrow where a ball of 0.6 r fits in and not
even one of 0.36 r gets out.

From what is connected, liquid in a part that stands runs out sideways and down.  Where each way
out rises it stays as a *pool*, up to the lowest point of the passage over which it would spill,
which lies r below the ball's centre; it runs out once the part is turned.

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

# Cells along the ball's diameter, where the part is not too large for it.
CELLS_PER_BALL = 6.0
MOST_CELLS = 16e6
# Balls for spaces that the ball itself does not fit in, and that must get out of them, in r.
SMALL, SMALL_OUT = 0.6, 0.36
# How exactly the widest way out is measured.
WAY_OUT_MM = 0.05
# Ladder of balls by which enclosed spaces are told from open ones, and how much wider they are.
LADDER, ENCLOSED = 1.5, 2.0
# A pool must be this deep, in cells: less may be the grid's own stairs.
LEAST_CELLS = 2.0


@dataclass(frozen=True)
class Pocket:
    """Something that does not run out.

    kind : "sealed" and "narrow" stay however the part is turned, a "pool" while it stands.
    volume_mm3 : what stays;  place_mm : (x, y, z) the lowest place of it.
    depth_mm : from that place to the highest that stays.
    enclosed : it lies in a cavity; False in the open, as in a mug (pools only).
    way_out_mm : of what stays for good, the diameter of the widest ball that gets out, to 0.05 mm
        or half a cell; 0 where sealed, None for a pool.
    cavity : index of the given cavity it lies in, None when in none.
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
) -> tuple[Pocket, ...]:
    """What stays in a part, standing as it prints, that drains through holes of a diameter.

    Parameters
    ----------
    part : with its holes, z upward.
    diameter_mm : of the ball that must be able to leave.
    cavities : the spaces hollowed out of it, without holes, to say which one a pocket lies in.
    pitch_mm : of the grid; a sixth of the diameter without, or what 16 million cells allow.
    least_mm3 : pockets smaller than this are left out; the ball's own volume without.

    Returns
    -------
    What stays for good first, then pools; the largest of each first.
    """
    if part.is_empty():
        return ()
    least = np.pi / 6 * diameter_mm**3 if least_mm3 is None else least_mm3
    space = pour_space(part, diameter_mm, pitch_mm)
    if space.empty.all():  # thinner than a cell everywhere
        return ()
    room = space.room_for(diameter_mm / 2)
    found = [*_shut(space, room, diameter_mm / 2), *_pools(space, room, diameter_mm / 2, least)]
    pockets = [_placed(pocket, space, cavities) for pocket in found]
    kept = [pocket for pocket in pockets if pocket.volume_mm3 >= least]
    return tuple(sorted(kept, key=lambda item: (item.kind == "pool", -item.volume_mm3)))


def pour_space(part: Manifold, diameter_mm: float, pitch_mm: float | None = None) -> Clearance:
    """The grid on which a ball of a diameter is followed, with room for it all around."""
    if pitch_mm is None:
        low, high = np.reshape(part.bounding_box(), (2, 3))
        volume = float(np.prod(high - low + 2 * diameter_mm))
        pitch_mm = max(diameter_mm / CELLS_PER_BALL, (volume / MOST_CELLS) ** (1 / 3))
    margin = diameter_mm / 2 + 3 * pitch_mm
    return space_around(part, pitch_mm, margin)


@dataclass(frozen=True, eq=False)
class _Found:
    """Cells of a pocket, flat indices, with what is known of it."""

    kind: Kind
    cells: Int
    enclosed: bool
    way_out_mm: float | None


def _shut(space: Clearance, fits: Bool, radius_mm: float) -> list[_Found]:
    """What no ball leaves, whichever way the part is turned."""
    empty, outside = connected_pieces(space.empty, diagonal=False)
    room, free = connected_pieces(fits, diagonal=True)
    small, small_free = connected_pieces(space.clearance_mm >= SMALL * radius_mm, diagonal=True)
    way, way_free = connected_pieces(
        space.clearance_mm >= SMALL_OUT * radius_mm - space.grid.pitch_mm / 2, diagonal=True
    )
    shut = (room > 0) & (room != free)
    # Smaller spaces, where the ball is nowhere near.
    shut |= (small > 0) & (small != small_free) & (way != way_free)
    sealed = space.empty & (empty != outside)
    if not (shut.any() or sealed.any()):
        return []
    from scipy.ndimage import label

    seeds, count = label(shut | sealed, structure=np.ones((3, 3, 3)))
    seeds[room == free] = count + 1
    owner = spread_within(space.empty, seeds)
    found = []
    for _, cells in cells_of_each(owner, count):
        if sealed.flat[cells].all():
            found.append(_Found("sealed", cells, True, 0.0))
        else:
            way_out = _way_out_mm(space, cells, room == free, radius_mm)
            found.append(_Found("narrow", cells, True, way_out))
    return found


def _way_out_mm(space: Clearance, cells: Int, free: Bool, radius_mm: float) -> float:
    """Diameter of the widest ball that gets from these cells to where the ball itself is free."""
    mine = np.zeros(free.shape, dtype=bool)
    mine.flat[cells] = True
    margin = int(np.ceil(2 * radius_mm / space.grid.pitch_mm)) + 4
    block = block_around(mine, margin)
    near, inside, out = space.within(block), mine[block], free[block]
    passes, stays = 0.0, radius_mm
    while stays - passes > WAY_OUT_MM / 2:
        middle = (passes + stays) / 2
        pieces, _ = connected_pieces(near.room_for(middle) | out, diagonal=True)
        if len(np.intersect1d(pieces[inside & (pieces > 0)], pieces[out])):
            passes = middle
        else:
            stays = middle
    return 2 * passes


def _pools(space: Clearance, room: Bool, radius_mm: float, least_mm3: float) -> list[_Found]:
    """What stays in a standing part although there is a way out."""
    pitch = space.grid.pitch_mm
    flood = basins(room, edge_cells(room.shape), diagonal=True)
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
    seeds[room & (seeds == 0)] = len(deep) + 1
    owner = spread_within(space.empty, seeds)
    rooms = None
    found = []
    for number, cells in cells_of_each(owner, len(deep)):
        # The liquid's surface lies at the lowest point of the passage.
        surface = flood.spill[deep[number - 1]] - radius_mm / pitch
        wet = cells[cells % room.shape[2] < surface]
        if len(wet) * pitch**3 < least_mm3:
            continue
        if rooms is None:
            rooms = _enclosed(space, room, radius_mm)
        centres = cells[room.flat[cells]]
        found.append(_Found("pool", wet, _mostly(rooms.flat[centres]), None))
    return found


def _enclosed(space: Clearance, room: Bool, radius_mm: float) -> Bool:
    """Cells of the ball's room that belong to spaces wider than their ways out."""
    widest, radius = float(space.clearance_mm.max()), LADDER * radius_mm
    seeds, edge = np.zeros(room.shape, dtype=np.int32), edge_cells(room.shape)
    while ENCLOSED * radius <= widest:
        # Beyond the edge there is all the room in the world.
        pieces, free = connected_pieces((space.clearance_mm >= radius) | edge, diagonal=True)
        count = int(pieces.max())
        largest = np.zeros(count + 1, dtype=np.float32)
        inside = pieces > 0
        np.maximum.at(largest, pieces[inside], space.clearance_mm[inside])
        roomy = largest >= ENCLOSED * radius
        roomy[free] = False
        if roomy.any():
            seeds[pieces == free] = 2
            seeds[roomy[pieces]] = 1
        radius *= LADDER
    return np.asarray(spread_within(room, seeds) == 1)


def _mostly(flags: Bool) -> bool:
    return bool(2 * np.count_nonzero(flags) > len(flags))


def _placed(found: _Found, space: Clearance, cavities: Sequence[Manifold]) -> Pocket:
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
    from printprep.grid.distance import Surface

    for number, cavity in enumerate(cavities):
        if bool(Surface.of(cavity).contains(place[None])[0]):
            return number
    return None
