"""Find the feet of columns: where a straight column's whole rim enters the shell."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float
    from printprep.supports.column_forest import Forest
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

STEP_MM = 0.25
# A foot goes so far beyond the first depth found: the lookup's lattice may be off by so much.
BEYOND_MM = 0.5
_RIM = 12
# Directions to try: (share of the largest lean's tangent, how many around).
_FANS = ((0.0, 1), (0.5, 6), (1.0, 16))
# Falls tried together.
_CHUNK = 12


def ring(count: int) -> Float:
    """(count, 3) corners of a regular polygon in the horizontal circle of radius 1."""

    turn = 2 * np.pi * np.arange(count) / count
    return np.stack([np.cos(turn), np.sin(turn), np.zeros(count)], axis=1)


def disc() -> Float:
    """(m, 3) offsets over the horizontal disc of radius 1: middle, half radius, and rim."""
    return np.concatenate([np.zeros((1, 3)), ring(_RIM // 2) / 2, ring(_RIM)])


def directions(tan: float) -> Float:
    """(k, 3) directions down, as offsets per mm of fall, up to a lean of tangent ``tan``."""
    fans = []
    for share, count in _FANS:
        turn = 2 * math.pi * np.arange(count) / count
        way = share * tan * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        fans.append(np.column_stack([way, np.full(count, -1.0)]))
    return np.concatenate(fans)


def nearest_feet(
    places: Float, above_mm: Float, lookup: InsideLookup, members: MemberSizes, deepest_mm: float
) -> tuple[Float, Float]:
    """Find the nearest feet of straight columns from places (n, 3) mm.

    above_mm : (n,) mm, longest way up from each place to a tip.
    Returns (n,) mm, the columns' lengths, inf where none stands within a fall of ``deepest_mm``,
    and (n, 3) mm, the middles of their feet.
    """
    ways = directions(members.lean_tan)
    lean = np.linalg.norm(ways, axis=1)
    price = np.full(len(places), np.inf)
    foot = places.copy()
    open_ = np.arange(len(places))
    start = 0.0
    while len(open_) and start <= deepest_mm:
        falls: Float = start + STEP_MM * np.arange(_CHUNK, dtype=np.float64)
        middle = places[open_, None, None] + falls[None, None, :, None] * ways[None, :, None]
        above = np.broadcast_to(above_mm[open_, None, None], middle.shape[:3])
        held = _held(middle, above, falls[None, None, :], lean[None, :, None], lookup, members)
        cost = np.where(held, np.inf, falls[None, None, :] * lean[None, :, None])
        flat = cost.reshape(len(open_), -1)
        best = flat.argmin(axis=1)
        price[open_] = flat[np.arange(len(open_)), best]
        foot[open_] = middle.reshape(len(open_), -1, 3)[np.arange(len(open_)), best]
        open_ = open_[np.isinf(price[open_])]
        start += STEP_MM * _CHUNK
    return price, foot


def set_feet(forest: Forest, lookup: InsideLookup, members: MemberSizes) -> None:
    """Move the end of every standing column along its line to where its rim is in the shell.

    Its thickness there follows from the load it carries now.
    """
    if not forest.stands:
        return
    uppers = {lower: upper for upper, lower in enumerate(forest.down) if lower >= 0}
    start = np.array([forest.place(uppers[index]) for index in forest.stands])
    way = np.array([forest.place(index) for index in forest.stands]) - start
    way /= -way[:, 2:]
    above = np.array([forest.above_mm[uppers[index]] for index in forest.stands])
    lean = np.linalg.norm(way, axis=1)
    fall = np.zeros(len(start))
    going = np.arange(len(start))
    while len(going):
        middle = start[going] + fall[going, None] * way[going]
        held = _held(middle, above[going], fall[going], lean[going], lookup, members)
        going = going[held]
        fall[going] += STEP_MM
    ends = start + (fall[:, None] + BEYOND_MM) * way
    for index, end in zip(forest.stands, ends, strict=True):
        forest.move(index, end)


def _held(
    middle: Float,
    above_mm: Float,
    fall_mm: Float,
    lean: Float,
    lookup: InsideLookup,
    members: MemberSizes,
) -> Bool:
    """(…,) whether part of a column's section still lies in the hollowable volume.

    middle : (…, 3) mm, of the section;  above_mm : (…,) mm, longest way up from the column's upper
    end;  fall_mm : (…,) mm, from there down;  lean : (…,) length per mm of fall.
    """
    radius = members.across_mm(above_mm + fall_mm * lean) * lean + lookup.step_mm / 2
    held = lookup.contains(middle)
    # The middle alone decides most sections.
    rest = ~held
    points = middle[rest][:, None, :] + radius[rest][:, None, None] * disc()[1:]
    held[rest] = lookup.contains(points).any(axis=-1)
    return held
