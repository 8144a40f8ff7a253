"""Solids of known volume, centre of mass and tilt angle, sitting on the bed."""

from __future__ import annotations

import numpy as np
from manifold3d import Manifold

from printprep.types import Repair, Solid


def box(x: float, y: float, z: float) -> Manifold:
    """A box centred on x = y = 0."""
    return Manifold.cube((x, y, z), True).translate((0, 0, z / 2))


def cylinder(radius: float, height: float, segments: int = 256) -> Manifold:
    return Manifold.cylinder(height, radius, radius, segments)


def cone(radius: float, height: float, segments: int = 256) -> Manifold:
    return Manifold.cylinder(height, radius, 0.0, segments)


def sphere(radius: float, segments: int = 256) -> Manifold:
    return Manifold.sphere(radius, segments).translate((0, 0, radius))


def leaning_prism(side: float, height: float, lean_mm: float) -> Manifold:
    """A square prism sheared toward +x: its top lies ``lean_mm`` beyond its foot."""
    shear = np.array([[1, 0, lean_mm / height, 0], [0, 1, 0, 0], [0, 0, 1, 0]], dtype=float)
    return box(side, side, height).transform(shear)


def solid(manifold: Manifold, name: str = "test") -> Solid:
    return Solid(manifold, name, Repair("as-is"), np.eye(4))
