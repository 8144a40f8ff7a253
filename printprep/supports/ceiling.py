"""Sample the ceilings that are too flat to print, as points on a lattice."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals, arrays
from printprep.mesh.winding_columns import crossings_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

# Each sample stands for a square of this side, seen from below.
SPACING_MM = 0.3
# The lattice avoids round numbers, where meshes have their edges.
_JITTER = (0.4142135624, 0.7320508076)


def ceiling_samples(
    hollowable_volume: Manifold, theta_deg: float, spacing_mm: float = SPACING_MM
) -> Float:
    """(n, 3) mm, points on faces that overhang more than θ from the vertical, by column, upward.

    A face of a cavity with outward normal n overhangs by asin n_z.
    """
    vertices, faces = arrays(hollowable_volume)
    if len(faces) == 0:
        return np.zeros((0, 3))
    corners = vertices[faces]
    normals = area_normals(corners)
    steep = math.sin(math.radians(theta_deg)) * np.linalg.norm(normals, axis=1)
    flat = faces[normals[:, 2] > steep]
    if len(flat) == 0:
        return np.zeros((0, 3))
    low = vertices[flat].min(axis=(0, 1))[:2] + spacing_mm * (np.array(_JITTER) - 1)
    high = vertices[flat].max(axis=(0, 1))[:2]
    axes = [np.arange(low[k], high[k] + spacing_mm, spacing_mm) for k in range(2)]
    columns = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    hits = crossings_of(vertices, flat, columns)
    return np.column_stack([columns[hits.column], hits.z_mm])
