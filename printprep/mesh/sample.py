"""Points on the surface of a mesh, spread evenly over its area."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points on triangles.

    points : (k, 3) mm;  area_normals : (k, 3) mm², outward normal of the triangle that a point lies
    on, as long as twice its area;  surface_mm2 : area of the whole surface.
    """

    points: Float
    area_normals: Float
    surface_mm2: float


def points_on_surface(
    vertices: Float, faces: Int, shares: Float, rng: np.random.Generator
) -> SurfacePoints:
    """One point for each share of the area: where it falls, counted triangle by triangle.

    vertices : (n, 3) mm;  faces : (m, 3);  shares : (k,) in [0, 1);  rng : chooses the place in the
    triangle, with equal density everywhere (Osada et al., "Shape distributions", 2002).
    """
    corners = vertices[faces]
    normals = area_normals(corners)
    cumulative = np.cumsum(np.linalg.norm(normals, axis=1))
    face = np.searchsorted(cumulative, shares * cumulative[-1], side="right")
    face = np.minimum(face, len(faces) - 1)
    u, v = np.sqrt(rng.random(len(shares))), rng.random(len(shares))
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points = np.einsum("nk,nkj->nj", weights, corners[face])
    return SurfacePoints(points, normals[face], float(cumulative[-1]) / 2)
