"""Feet: straight columns from a place down to where their whole rim is in the shell."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float
    from printprep.supports.dexels import Dexels
    from printprep.supports.forest import Forest
    from printprep.supports.members import Members

STEP_MM = 0.25
# So far beyond the first depth found: what the lattice of dexels may misjudge.
BEYOND_MM = 0.5
_RIM = 12
# Directions tried: (share of the steepest lean's tangent, how many around).
_FANS = ((0.0, 1), (0.5, 6), (1.0, 16))
# Falls looked at together.
_CHUNK = 12


def ring(count: int) -> Float:
    """(count, 3) corners of a regular polygon in the horizontal circle of radius 1."""
    turn = 2 * np.pi * np.arange(count) / count
    return np.stack([np.cos(turn), np.sin(turn), np.zeros(count)], axis=1)


def disc() -> Float:
    """(m, 3) offsets over the horizontal disc of radius 1: middle, half way out, and rim."""
    return np.concatenate([np.zeros((1, 3)), ring(_RIM // 2) / 2, ring(_RIM)])


def directions(tan: float) -> Float:
    """(k, 3) ways down, by their offset per mm of fall."""
    fans = []
    for share, count in _FANS:
        turn = 2 * math.pi * np.arange(count) / count
        way = share * tan * np.stack([np.cos(turn), np.sin(turn)], axis=1)
        fans.append(np.column_stack([way, np.full(count, -1.0)]))
    return np.concatenate(fans)


def nearest_feet(
    places: Float, above_mm: Float, dexels: Dexels, members: Members, deepest_mm: float
) -> tuple[Float, Float]:
    """Where straight columns from places (n, 3) would stand soonest.

    Returns (n,) their lengths, inf where none stands within a fall of
    ``deepest_mm``, and (n, 3) the middles of their feet.
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
        held = _held(middle, above, falls[None, None, :], lean[None, :, None], dexels, members)
        cost = np.where(held, np.inf, falls[None, None, :] * lean[None, :, None])
        flat = cost.reshape(len(open_), -1)
        best = flat.argmin(axis=1)
        price[open_] = flat[np.arange(len(open_)), best]
        foot[open_] = middle.reshape(len(open_), -1, 3)[np.arange(len(open_)), best]
        open_ = open_[np.isinf(price[open_])]
        start += STEP_MM * _CHUNK
    return price, foot


def set_feet(forest: Forest, dexels: Dexels, members: Members) -> None:
    """Move the end of every standing column along its line to where its rim is in the shell.

    It is as thick there as what it carries by now asks for.
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
        held = _held(middle, above[going], fall[going], lean[going], dexels, members)
        going = going[held]
        fall[going] += STEP_MM
    ends = start + (fall[:, None] + BEYOND_MM) * way
    for index, end in zip(forest.stands, ends, strict=True):
        forest.move(index, end)


def _held(
    middle: Float, above_mm: Float, fall_mm: Float, lean: Float, dexels: Dexels, members: Members
) -> Bool:
    """Whether some of a column's section still lies in the room; arrays of one leading shape."""
    radius = members.across_mm(above_mm + fall_mm * lean) * lean + dexels.step_mm / 2
    held = dexels.contains(middle)
    # Most sections are decided by their middles.
    rest = ~held
    points = middle[rest][:, None, :] + radius[rest][:, None, None] * disc()[1:]
    held[rest] = dexels.contains(points).any(axis=-1)
    return held
