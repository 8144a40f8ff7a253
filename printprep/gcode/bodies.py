"""Assigns beads to bodies, where the part has several that do not touch."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, distance_to_mesh_mm, winding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int


_NEAR_MM = 1.0  # how far layers and lines may put the axis of a bead outside its body


class Bodies:
    """Solids that do not touch, in the coordinates of the G-code."""

    def __init__(self, solids: Sequence[Manifold]) -> None:
        self._meshes = [arrays(solid) for solid in solids]

    def owner(self, points: Float) -> Int:
        """(k,) index of the body that each point (k, 3) mm lies in, else of the nearest one."""
        boxed = np.stack([_in_box(points, vertices) for vertices, _ in self._meshes])
        owner: Int = np.argmax(boxed, axis=0)
        doubtful = np.flatnonzero(boxed.sum(axis=0) != 1)
        if len(doubtful):
            far = np.stack([_outside_mm(points[doubtful], *mesh) for mesh in self._meshes])
            owner[doubtful] = np.argmin(far, axis=0)
        return owner


def _in_box(points: Float, vertices: Float) -> Bool:
    """(k,) whether points (k, 3) lie in the bounding box of vertices (n, 3), a little widened."""
    low, high = vertices.min(axis=0) - _NEAR_MM, vertices.max(axis=0) + _NEAR_MM
    inside: Bool = ((points > low) & (points < high)).all(axis=1)
    return inside


def _outside_mm(points: Float, vertices: Float, faces: Int) -> Float:
    """(k,) mm from points (k, 3) to a solid (vertices (n, 3), faces (m, 3)), 0 inside it."""
    inside = winding(points, vertices, faces) > 0.5
    far = np.zeros(len(points))
    far[~inside] = distance_to_mesh_mm(points[~inside], vertices, faces)
    return far
