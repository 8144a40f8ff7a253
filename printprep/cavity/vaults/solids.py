"""Capitals and columns as convex solids of the boolean kernel.

Every section is a regular polygon around the disc it stands for, all turned alike, so that a
frustum between two of them has flat sides.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import try_manifold

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.cavity.vaults.capitals import Capitals
    from printprep.cavity.vaults.forest import Forest
    from printprep.cavity.vaults.members import Members
    from printprep.types import Float

SIDES = 12
# Solids that only touch would leave coincident faces: each goes on so far into the next.
INTO_MM = 0.03
# A funnel ends so far above the ceiling it carries.
BEYOND_MM = 0.3


def capital_solids(capitals: Capitals, members: Members) -> list[Manifold]:
    """Funnels, from each node up to a little over its top."""
    solids = []
    for node, top in zip(capitals.node_mm, capitals.top_mm, strict=True):
        rise = max(float(top - node[2]), 0.0) + BEYOND_MM
        upper = node + np.array([0.0, 0.0, rise])
        solids.append(
            frustum(node, members.radius_mm, upper, members.radius_mm + rise * members.tan)
        )
    return solids


def column_solids(forest: Forest, members: Members) -> list[Manifold]:
    """Frustums between the places of a forest, thick enough for what they carry."""
    solids = []
    radius = np.zeros(len(forest))
    places = np.array([forest.place(index) for index in range(len(forest))]).reshape(-1, 3)
    for index in np.argsort(-places[:, 2], kind="stable").tolist():
        lower = forest.down[index]
        if lower < 0:
            continue
        way = places[lower] - places[index]
        fall, length = -float(way[2]), float(np.linalg.norm(way))
        if fall <= 0:
            continue
        above = forest.above_mm[index]
        thick = members.across_mm(np.array([above, above + length])) * length / fall
        start = max(float(radius[index]), float(thick[0]))
        end = max(start, float(thick[1]))
        radius[lower] = max(float(radius[lower]), end)
        up = places[index] - way * (INTO_MM / fall)
        solids.append(frustum(places[lower], end, up, start))
    return solids


def frustum(low: Float, low_radius: float, high: Float, high_radius: float) -> Manifold:
    """The solid between regular polygons around two horizontal discs, middles (x, y, z)."""
    turn = 2 * np.pi * (np.arange(SIDES) + 0.5) / SIDES
    ring = np.stack([np.cos(turn), np.sin(turn), np.zeros(SIDES)], axis=1) / np.cos(np.pi / SIDES)
    vertices = np.concatenate([low + low_radius * ring, high + high_radius * ring])
    manifold, status = try_manifold(vertices, _FACES)
    if status != "NoError":
        raise ArithmeticError(f"a frustum from {low} to {high} is no solid: {status}")
    return manifold


def _faces() -> np.ndarray:
    faces = []
    for i in range(SIDES):
        j = (i + 1) % SIDES
        faces += [(i, j, SIDES + j), (i, SIDES + j, SIDES + i)]
    for i in range(1, SIDES - 1):
        faces += [(0, i + 1, i), (SIDES, SIDES + i, SIDES + i + 1)]
    return np.array(faces, dtype=np.int64)


_FACES = _faces()
