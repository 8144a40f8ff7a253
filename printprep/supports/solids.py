"""Capitals and columns as convex solids of the boolean kernel.

A round section is a regular polygon around its circle.  A column is round across its axis; its
level section is an ellipse, longer toward the lean.  Where columns meet, the lower one begins with
the hull of all that stand on it, so that it covers every joint.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.supports.capitals import Capitals
    from printprep.supports.column_forest import Forest
    from printprep.supports.member_sizes import MemberSizes

FUNNEL_SIDES = 12
COLUMN_SIDES = 8
# Solids that only touch leave coincident faces: each reaches so far into the next.
INTO_MM = 0.03
# A funnel ends so far above the ceiling it carries.
BEYOND_MM = 0.3
# A column with a smaller fall keeps the whole section it begins with: narrowing over so short a
# way, its side leans too far out beside its axis.
SHORT_MM = 2.0


@dataclass(frozen=True, eq=False)
class Frustum:
    """The hull of level sections.

    corners : (n, 3) mm, of all sections;  across_mm : least thickness across its axis.
    """

    corners: Float
    across_mm: float

    @staticmethod
    def of_discs(low: Float, low_radius_mm: float, high: Float, high_radius_mm: float) -> Frustum:
        """The hull of two level discs with middles (3,) mm, ``low`` under ``high``."""
        upright = np.array([0.0, 0.0, -1.0])
        lower = low + section(upright, low_radius_mm, FUNNEL_SIDES)
        upper = high + section(upright, high_radius_mm, FUNNEL_SIDES)
        way = high - low
        cosine = float(way[2] / np.linalg.norm(way))
        across_mm = 2 * min(low_radius_mm, high_radius_mm) * cosine
        return Frustum(np.concatenate([lower, upper]), across_mm)

    def bounds(self) -> tuple[Float, Float]:
        """Lower and upper corner (3,) mm of a box around it, both (x, y, z)."""
        return self.corners.min(axis=0), self.corners.max(axis=0)


def section(way: Float, radius_mm: float, sides: int = COLUMN_SIDES) -> Float:
    """(sides, 3) mm, corners of the level section of a round column along ``way`` (3,)."""
    steep = float(np.hypot(way[0], way[1]))
    along = way[:2] / steep if steep > 0 else np.array([1.0, 0.0])
    longer = float(np.linalg.norm(way)) / abs(float(way[2]))
    turn = 2 * np.pi * (np.arange(sides) + 0.5) / sides
    around = radius_mm / np.cos(np.pi / sides)
    toward, aside = around * longer * np.cos(turn), around * np.sin(turn)
    across = np.array([-along[1], along[0]])
    level = toward[:, None] * along + aside[:, None] * across
    return np.column_stack([level, np.zeros(sides)])


def united(pieces: Sequence[Frustum]) -> Manifold:
    """Unite pieces into one solid."""
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(
        [Manifold.hull_points(piece.corners) for piece in pieces], OpType.Add
    )


def funnels(capitals: Capitals, members: MemberSizes) -> list[Frustum]:
    """The solids of capitals, from each node up to a little over its top."""
    found = []
    for node, top in zip(capitals.node_mm, capitals.top_mm, strict=True):
        rise = max(float(top - node[2]), 0.0) + BEYOND_MM
        wide = members.radius_mm + rise * members.tan
        high = node + np.array([0.0, 0.0, rise])
        found.append(Frustum.of_discs(node, members.radius_mm, high, wide))
    return found


def columns(forest: Forest, members: MemberSizes) -> list[Frustum]:
    """The solids of a forest's columns, from above, as thick as their load needs."""
    found = []
    places = np.array([forest.place(index) for index in range(len(forest))]).reshape(-1, 3)
    standing: list[list[Float]] = [[] for _ in places]
    for index in np.argsort(-places[:, 2], kind="stable").tolist():
        lower = forest.down[index]
        if lower < 0:
            continue
        way = places[lower] - places[index]
        fall, length = -float(way[2]), float(np.linalg.norm(way))
        if fall <= 0:  # both are at one place
            standing[lower] += standing[index]
            continue
        above = forest.above_mm[index]
        half = members.across_mm(np.array([above, above + length]))
        begin = np.concatenate([section(way, float(half[0])), *standing[index]])
        end = section(way, float(half[1]))
        if fall < SHORT_MM:
            end = np.concatenate([end, *standing[index]])
        standing[lower].append(end)
        up = places[index] - way * (INTO_MM / fall)
        found.append(Frustum(np.concatenate([places[lower] + end, up + begin]), 2 * float(half[0])))
    return found
