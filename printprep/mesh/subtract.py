"""Subtracts the negative volumes of a project from their objects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError
from printprep.mesh.carry import carried
from printprep.mesh.measure import arrays
from printprep.mesh.repair import repair
from printprep.mesh.weld import compact, weld
from printprep.types import Model, Paint

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int
    from printprep.threemf.read import ThreeMF

# The size comes later (--size); only what no kernel can work on is refused here.
_SMALLEST_MM, _LARGEST_MM = 1e-6, 1e9


@dataclass(frozen=True, eq=False)
class Subtracted:
    """A mesh without its negative volumes: vertices (n, 3) mm, faces (m, 3), their paint."""

    vertices: Float
    faces: Int
    paint: Paint | None


def subtracted(found: ThreeMF, what: str) -> Subtracted:
    """Objects of a 3MF, each without its own negative volumes; the others stay as they are.

    Raises GeometryError where a volume is no solid, or nothing is left of an object.
    """
    from manifold3d import Manifold, OpType

    vertices: list[Float] = []
    faces: list[Int] = []
    labels: list[Int] = []
    styles = [] if found.paint is None else list(found.paint.styles)
    count = 0
    for number, (first, end) in enumerate(found.spans):
        points, corners = compact(found.vertices, found.faces[first:end])
        painted = None if found.paint is None else found.paint.labels[first:end]
        minus = [negative for negative in found.negatives if negative.span == number]
        if minus and len(corners):
            name = f"{what}: the object {found.names[number]!r}"
            solids = [_solid(points, corners, name)]
            solids += [
                _solid(one.vertices, one.faces, f"{what}: the negative volume {one.name!r}")
                for one in minus
            ]
            rest = Manifold.batch_boolean(solids, OpType.Subtract)
            if not rest.volume() > 0:
                raise GeometryError(
                    f"{name} is covered by its negative volumes: nothing is left of it.",
                    "Make the negative volumes smaller in the slicer.",
                )
            left, left_corners = arrays(rest)
            if found.paint is not None and painted is not None:
                before = Paint(tuple(styles), painted)
                after = carried(before, points, corners, left, left_corners)
                styles, painted = list(after.styles), after.labels
            points, corners = left, left_corners
        vertices.append(points)
        faces.append(corners + count)
        count += len(points)
        if painted is not None:
            labels.append(painted)
    paint = None if found.paint is None else Paint(tuple(styles), np.concatenate(labels))
    return Subtracted(np.concatenate(vertices), np.concatenate(faces), paint)


def _solid(vertices: Float, faces: Int, name: str) -> Manifold:
    """The solid of a mesh, where it is: vertices (n, 3) mm, faces (m, 3)."""
    longest = float(np.ptp(vertices, axis=0).max())
    if not _SMALLEST_MM <= longest <= _LARGEST_MM:
        raise GeometryError(
            f"{name} is {longest:.4g} mm along its longest side, which no solid is.",
            "Name the unit of the file with --units.",
        )
    found = repair(Model(*weld(vertices, faces), np.eye(4), name))
    x, y, z = found.placement[:3, 3]
    return found.manifold.translate((-float(x), -float(y), -float(z)))
