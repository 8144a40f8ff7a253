"""Whether a surface that was simplified is still the one it came from.

Only what changed is measured: triangles that one mesh has and the other has not.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, distance_to_mesh_mm
from printprep.mesh.rounding import rounded
from printprep.mesh.self_intersections import folded
from printprep.mesh.weld import unique_rows

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

FOLDS = "it folds over"
# Mean thickness of what a simplification may add or take over the whole surface.
_SKIN_MM = 1e-4


def unfaithful(before: Manifold, after: Manifold, moved_mm: float) -> str | None:
    """How a surface differs from the one it came from, None where it is the same.

    moved_mm : how far any point may move, from either surface to the other.  The volume may change
    by 0.0001 mm over the whole surface, and no fold may be new.
    """
    volume = abs(float(after.volume() - before.volume()))
    if volume > _SKIN_MM * float(before.surface_area()):
        return f"its volume changes by {volume:.3g} mm³"
    old, new = arrays(before), arrays(after)
    changed_old, changed_new = _changed(old, new)
    for points, mesh in (
        (_samples(new[0], new[1][changed_new]), old),
        (_samples(old[0], old[1][changed_old]), new),
    ):
        distance = float(distance_to_mesh_mm(points, *mesh).max(initial=0.0))
        if distance > moved_mm:
            return f"it moves by {distance:.3g} mm"
    if changed_new.any() and folded(*new) and not folded(*old):
        return FOLDS
    return None


def _samples(vertices: Float, faces: Int) -> Float:
    """(k, 3) mm, corners, middles of edges and centres of faces (m, 3) of vertices (n, 3) mm."""
    corners = vertices[faces]
    middles = (corners + np.roll(corners, -1, axis=1)) / 2
    centres = corners.mean(axis=1, keepdims=True)
    return unique_rows(np.concatenate([corners, middles, centres], axis=1).reshape(-1, 3))[0]


def _changed(one: tuple[Float, Int], other: tuple[Float, Int]) -> tuple[Bool, Bool]:
    """Which faces of each mesh the other lacks: (m,) and (k,), by rounded positions of corners.

    one, other : vertices (n, 3) mm, and faces (m, 3) and (k, 3).
    """
    _, index = unique_rows(rounded(np.concatenate([one[0], other[0]])))
    first = np.sort(index[: len(one[0])][one[1]], axis=1)
    second = np.sort(index[len(one[0]) :][other[1]], axis=1)
    _, number = unique_rows(np.concatenate([first, second]))
    here, there = number[: len(first)], number[len(first) :]
    return ~np.isin(here, there), ~np.isin(there, here)
