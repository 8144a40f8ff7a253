"""Capitals and columns as convex solids of the boolean kernel.

Every section is a regular polygon around the disc it stands for, all turned alike, so that a
frustum between two of them has flat sides.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import from_arrays

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.cavity.vaults.capitals import Capitals
    from printprep.cavity.vaults.forest import Forest
    from printprep.cavity.vaults.members import Members
    from printprep.types import Float, Int

SIDES = 12
# Solids that only touch would leave coincident faces: each goes on so far into the next.
INTO_MM = 0.03
# A funnel ends so far above the ceiling it carries.
BEYOND_MM = 0.3


@dataclass(frozen=True, eq=False)
class Frustum:
    """What lies between two horizontal discs, middles (x, y, z), ``low`` under ``high``."""

    low: Float
    low_radius_mm: float
    high: Float
    high_radius_mm: float

    @property
    def across_mm(self) -> float:
        """Its least thickness across its axis."""
        way = self.high - self.low
        cosine = float(way[2] / np.linalg.norm(way))
        return 2 * min(self.low_radius_mm, self.high_radius_mm) * cosine

    def bounds(self) -> tuple[Float, Float]:
        """Lower and upper corner of a box around it."""
        wide = max(self.low_radius_mm, self.high_radius_mm) / np.cos(np.pi / SIDES)
        ends = np.stack([self.low, self.high])
        margin = np.array([wide, wide, 0.0])
        return ends.min(axis=0) - margin, ends.max(axis=0) + margin

    def corners(self) -> Float:
        """(2 SIDES, 3) of regular polygons around the discs, the lower one first."""
        turn = 2 * np.pi * (np.arange(SIDES) + 0.5) / SIDES
        ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(SIDES)], axis=1)
        ring /= np.cos(np.pi / SIDES)
        lower = self.low + self.low_radius_mm * ring
        return np.concatenate([lower, self.high + self.high_radius_mm * ring])


def united(pieces: Sequence[Frustum]) -> Manifold:
    """All pieces as one solid."""
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(
        [from_arrays(piece.corners(), _FACES) for piece in pieces], OpType.Add
    )


def funnels(capitals: Capitals, members: Members) -> list[Frustum]:
    """Capitals, from each node up to a little over its top."""
    found = []
    for node, top in zip(capitals.node_mm, capitals.top_mm, strict=True):
        rise = max(float(top - node[2]), 0.0) + BEYOND_MM
        wide = members.radius_mm + rise * members.tan
        found.append(Frustum(node, members.radius_mm, node + np.array([0.0, 0.0, rise]), wide))
    return found


def columns(forest: Forest, members: Members) -> list[Frustum]:
    """Between the places of a forest, from above, thick enough for what they carry.

    None begins narrower than those that lean on it end, so that every joint is covered.
    """
    found = []
    radius = np.zeros(len(forest))
    places = np.array([forest.place(index) for index in range(len(forest))]).reshape(-1, 3)
    for index in np.argsort(-places[:, 2], kind="stable").tolist():
        lower = forest.down[index]
        if lower < 0:
            continue
        way = places[lower] - places[index]
        fall, length = -float(way[2]), float(np.linalg.norm(way))
        if fall <= 0:  # two tips in one place
            radius[lower] = max(float(radius[lower]), float(radius[index]))
            continue
        above = forest.above_mm[index]
        thick = members.across_mm(np.array([above, above + length])) * length / fall
        start = max(float(radius[index]), float(thick[0]))
        end = max(start, float(thick[1]))
        radius[lower] = max(float(radius[lower]), end)
        up = places[index] - way * (INTO_MM / fall)
        found.append(Frustum(places[lower], end, up, start))
    return found


def _faces() -> Int:
    faces = []
    for i in range(SIDES):
        j = (i + 1) % SIDES
        faces += [(i, j, SIDES + j), (i, SIDES + j, SIDES + i)]
    for i in range(1, SIDES - 1):
        faces += [(0, i + 1, i), (SIDES, SIDES + i, SIDES + i + 1)]
    return np.array(faces, dtype=np.int64)


_FACES = _faces()
