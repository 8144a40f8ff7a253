"""Which of several bodies that do not touch a bead belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, distance_to_mesh_mm, winding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int


_NEAR_MM = 1.0  # a bead's axis lies within its body but for what layers and lines round off


class Bodies:
    """Disjoint solids, in the coordinates of the G-code."""

    def __init__(self, solids: Sequence[Manifold]) -> None:
        self._meshes = [arrays(solid) for solid in solids]

    def owner(self, points: Float) -> Int:
        """(n,) index of the body that points (n, 3) mm lie in, else of the nearest."""
        boxed = np.stack([_in_box(points, vertices) for vertices, _ in self._meshes])
        owner: Int = np.argmax(boxed, axis=0)
        open_ = np.flatnonzero(boxed.sum(axis=0) != 1)
        if len(open_):
            far = np.stack([_outside_mm(points[open_], *mesh) for mesh in self._meshes])
            owner[open_] = np.argmin(far, axis=0)
        return owner


def _in_box(points: Float, vertices: Float) -> Float:
    low, high = vertices.min(axis=0) - _NEAR_MM, vertices.max(axis=0) + _NEAR_MM
    inside: Float = ((points > low) & (points < high)).all(axis=1)
    return inside


def _outside_mm(points: Float, vertices: Float, faces: Int) -> Float:
    """(n,) distance to a solid, 0 inside."""
    inside = winding(points, vertices, faces) > 0.5
    far = np.zeros(len(points))
    far[~inside] = distance_to_mesh_mm(points[~inside], vertices, faces)
    return far
