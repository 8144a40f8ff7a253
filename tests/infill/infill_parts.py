"""Boxes, upright and leaning, whose figures are known by hand."""

from __future__ import annotations

import numpy as np
import trimesh
from manifold3d import Manifold

from printprep.mesh.measure import arrays
from printprep.types import Repair, Solid

FOOT, TALL, SHEAR = 20.0, 40.0, 12.0


def upright(size: float = FOOT, tall: float = TALL) -> Manifold:
    return Manifold.cube((size, size, tall)).translate((-size / 2, -size / 2, 0.0))


def leaning(wall_mm: float = 0.0) -> Manifold:
    """A box sheared along x: its centre lies SHEAR / 2 off the middle of its foot.

    Of one density it tips at atan((10 − 6) / 20) = 11.3°.  With a wall, the room inside it.
    """
    inside = Manifold.cube((FOOT - 2 * wall_mm, FOOT - 2 * wall_mm, TALL - 2 * wall_mm), True)
    return inside.translate((0.0, 0.0, TALL / 2)).warp(
        lambda at: (at[0] + SHEAR * at[2] / TALL, at[1], at[2])
    )


def solid_of(manifold: Manifold, name: str = "box") -> Solid:
    return Solid(manifold, name, Repair("as-is"), np.eye(4))


def mesh_of(manifold: Manifold, name: str = "box") -> trimesh.Trimesh:
    vertices, faces = arrays(manifold)
    return trimesh.Trimesh(vertices, faces, process=False, metadata={"name": name})
