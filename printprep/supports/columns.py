"""Columns: trees that lean at most θ, join one another, and stand on the shell.

The highest free tip comes next and takes the cheapest way down: to the shell; to the place where
its cone first meets another free tip's; or to a column already there.  Below a meeting, the rest of
the way to the shell counts (distance_to_footing.py), as thick as its load will need.
"""

from __future__ import annotations

import heapq
from typing import TYPE_CHECKING

import numpy as np

from printprep.supports.column_feet import STEP_MM, nearest_feet
from printprep.supports.column_forest import Forest

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.supports.distance_to_footing import DistanceToFooting
    from printprep.supports.inside_lookup import InsideLookup
    from printprep.supports.member_sizes import MemberSizes

# Other tips tried as partners: those with the highest meetings.
PARTNERS = 16
# Two places nearer than this are one.
SAME_MM = 1e-6
# Feet so near a tip are searched exactly, before any other way down is weighed.
NEAR_MM = 2.5
# A column's end is not final where it enters the shell: no other column leans on it there.
FOOT_MM = 1.0


def raise_columns(
    tips: Float,
    lookup: InsideLookup,
    footings: DistanceToFooting,
    members: MemberSizes,
    forest: Forest,
) -> None:
    """Carry every tip (n, 3) mm down to the shell, adding columns to the forest."""
    free = [forest.plant(tip) for tip in tips]
    near, feet = nearest_feet(tips, np.zeros(len(tips)), lookup, members, NEAR_MM)
    stubs = dict(zip(free, zip(near.tolist(), feet, strict=True), strict=True))
    waiting = dict.fromkeys(free, True)
    heap = [(-float(forest.place(index)[2]), index) for index in free]
    heapq.heapify(heap)
    while heap:
        _, tip = heapq.heappop(heap)
        if not waiting.pop(tip, False):
            continue
        place, above = forest.place(tip), forest.above_mm[tip]
        length = float(footings.way_mm(place[None])[0])
        near_mm, foot = stubs.get(tip, (np.inf, place))
        if np.isfinite(near_mm):
            length = near_mm
        cost = float(members.cost_mm3(above, length))
        meeting = _best_partner(
            tip, np.fromiter(waiting, np.int64), cost, footings, members, forest
        )
        if meeting is not None:
            cost = meeting[0]
        joint = _best_axis(tip, cost, members, forest)
        if joint is not None:
            forest.join(tip, joint)
        elif meeting is None:
            if np.isinf(near_mm):
                foot = _foot(place, above, lookup, members)
            forest.stand(tip, foot)
        else:
            _, partner, where, left = meeting
            if np.abs(where - forest.place(partner)).max() < SAME_MM:
                forest.lean_on(tip, partner, left)
                continue
            del waiting[partner]
            met = forest.plant(where)
            forest.lean_on(tip, met, left)
            forest.lean_on(partner, met, left)
            waiting[met] = True
            heapq.heappush(heap, (-float(where[2]), met))


def _foot(place: Float, above_mm: float, lookup: InsideLookup, members: MemberSizes) -> Float:
    """(3,) mm, the foot of the shortest straight column from a place (3,) mm."""
    deepest = float(place[2]) - lookup.floor_mm + STEP_MM
    _, feet = nearest_feet(place[None], np.array([above_mm]), lookup, members, deepest)
    foot: Float = feet[0]
    return foot


def _best_partner(
    tip: int,
    others: Int,
    cost: float,
    footings: DistanceToFooting,
    members: MemberSizes,
    forest: Forest,
) -> tuple[float, int, Float, float] | None:
    """The cheapest meeting with another tip; None where it costs ``cost`` mm³ or more.

    others : (k,) numbers of the tips to try.
    Returns cost in mm³ without the partner's own, partner, place (3,) mm of the meeting, and length
    in mm of the way below it.
    """
    if len(others) == 0:
        return None
    here, there = forest.place(tip), forest.places(others)
    away = there[:, :2] - here[:2]
    d = np.sqrt((away**2).sum(axis=1))
    lower = here[2] - there[:, 2]
    fall = np.maximum((lower + d / members.lean_tan) / 2, lower)
    near = np.argsort(fall, kind="stable")[:PARTNERS]
    others, there, away, d, fall = others[near], there[near], away[near], d[near], fall[near]
    share = np.minimum(fall * members.lean_tan, d) / np.maximum(d, SAME_MM)
    where = np.column_stack([here[:2] + share[:, None] * away, here[2] - fall])
    left, alone = footings.way_mm(where), footings.way_mm(there)
    above, above_others = forest.above_mm[tip], np.array([forest.above_mm[k] for k in others])
    mine, theirs = (np.linalg.norm(where - place, axis=1) for place in (here, there))
    trunk = np.maximum(above + mine, above_others + theirs)
    total = members.cost_mm3(above, mine) + members.cost_mm3(above_others, theirs)
    total += members.cost_mm3(trunk, left) - members.cost_mm3(above_others, alone)
    total[left <= 0] = np.inf
    best = int(np.argmin(total))
    if total[best] >= cost:
        return None
    return float(total[best]), int(others[best]), where[best], float(left[best])


def _best_axis(tip: int, cost: float, members: MemberSizes, forest: Forest) -> int | None:
    """The cheapest point of an axis to lean on; None where it costs ``cost`` mm³ or more."""
    here, above = forest.place(tip), forest.above_mm[tip]
    axes = forest.axes()
    fall = here[2] - axes.place_mm[:, 2]
    away = axes.place_mm[:, :2] - here[:2]
    d = np.sqrt((away**2).sum(axis=1))
    reach = (fall > 0) & (d <= fall * members.lean_tan) & (axes.below_mm > FOOT_MM)
    reach = np.flatnonzero(reach)
    if len(reach) == 0:
        return None
    length = np.hypot(fall[reach], d[reach])
    below, carried = axes.below_mm[reach], axes.above_mm[reach]
    total = members.cost_mm3(above, length)
    thicker = members.cost_mm3(np.maximum(carried, above + length), below)
    total += thicker - members.cost_mm3(carried, below)
    best = int(np.argmin(total))
    return int(reach[best]) if total[best] < cost else None
