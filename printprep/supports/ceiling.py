"""Sample the ceilings that are too flat to print, as points on a lattice."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.mesh.measure import area_normals, arrays
from printprep.mesh.winding_columns import crossings_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int

# Each sample stands for a square of this side, seen from below.
SPACING_MM = 0.3
# A ceiling of more than 450 cm² has its samples farther apart, so that there are no more.
MOST_SAMPLES = 500_000
# Five floors of a bed of 250 × 210 mm.  The work grows with the square of the ceilings.
MOST_CEILING_CM2 = 2500.0
# The lattice avoids round numbers, where meshes have their edges.
_JITTER = (0.4142135624, 0.7320508076)


def ceiling_samples(
    hollowable_volume: Manifold, theta_deg: float, spacing_mm: float = SPACING_MM
) -> Float:
    """(n, 3) mm, points on faces that overhang more than θ from the vertical, by column, upward.

    A face of a cavity with outward normal n overhangs by asin n_z.
    """
    vertices, flat, _ = _flat_faces(hollowable_volume, theta_deg)
    if len(flat) == 0:
        return np.zeros((0, 3))
    low = vertices[flat].min(axis=(0, 1))[:2] + spacing_mm * (np.array(_JITTER) - 1)
    high = vertices[flat].max(axis=(0, 1))[:2]
    axes = [np.arange(low[k], high[k] + spacing_mm, spacing_mm) for k in range(2)]
    columns = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 2)
    hits = crossings_of(vertices, flat, columns)
    return np.column_stack([columns[hits.column], hits.z_mm])


def spacing_of(hollowable_volume: Manifold, theta_deg: float) -> float:
    """Spacing in mm at which faces that overhang more than θ have at most ``MOST_SAMPLES``.

    Raises GeometryError where they are larger than ``MOST_CEILING_CM2``.
    """
    _, _, seen_mm2 = _flat_faces(hollowable_volume, theta_deg)
    if seen_mm2 / 100 > MOST_CEILING_CM2:
        raise GeometryError(
            f"The ceilings inside measure {seen_mm2 / 100:.0f} cm²; vaults are built for "
            f"{MOST_CEILING_CM2:.0f} cm² at most.",
            "Make the model smaller (--size), or leave out the vaults (--vaults none).",
        )
    return max(SPACING_MM, math.sqrt(seen_mm2 / MOST_SAMPLES))


def _flat_faces(hollowable_volume: Manifold, theta_deg: float) -> tuple[Float, Int, float]:
    """Vertices (n, 3) mm, the faces (m, 3) that overhang more than θ, and their area from below."""
    vertices, faces = arrays(hollowable_volume)
    normals = area_normals(vertices[faces])
    steep = math.sin(math.radians(theta_deg)) * np.linalg.norm(normals, axis=1)
    flat = normals[:, 2] > steep
    return vertices, faces[flat], float(normals[flat, 2].sum()) / 2
