"""Cut the cavity along the planes, leave out what is too small, and subtract it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.balls import deepest_points
from printprep.grid.distance import Surface
from printprep.mesh.measure import bodies
from printprep.mesh.quantize import quantized
from printprep.types import Base, Part, Plane, Solid

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float


# Where a search for the largest ball starts: as many of the points farthest from the surface.
STARTS = 8
# Cells along the longest side of the first lattice searched for a ball.
COARSE_CELLS = 12


def cut(
    hollowable_volume: Manifold, parts: Sequence[Manifold], planes: Sequence[Plane | None]
) -> Manifold:
    """What of the room for cavities lies above the plane of its body; one plane for each part."""
    from manifold3d import Manifold, OpType

    if len(parts) == 1:
        return _above(hollowable_volume, planes[0])
    pieces = [
        _above(hollowable_volume ^ body, plane) for body, plane in zip(parts, planes, strict=True)
    ]
    return Manifold.batch_boolean(pieces, OpType.Add)


def cavities_of(hollowable_volume: Manifold, min_feature_mm: float) -> tuple[Manifold, ...]:
    """The pieces of a cavity that can hold a ball of the minimum feature, largest first."""
    pieces = [
        piece for piece in bodies(hollowable_volume) if _holds_ball(piece, min_feature_mm / 2)
    ]
    return tuple(sorted(pieces, key=lambda piece: (-piece.volume(), piece.bounding_box())))


def make_part(solid: Solid, base: Base | None, cavities: Sequence[Manifold]) -> Part:
    """Unite the solid with its base and subtract the cavities, in the coordinates of a file."""
    from manifold3d import Manifold, OpType

    outside = solid.manifold if base is None else solid.manifold + base.manifold
    whole = Manifold.batch_boolean([outside, *cavities], OpType.Subtract)
    part = quantized(whole)
    return Part(part, outside, tuple(cavities), base, solid.name, solid.placement)


def _above(hollowable_volume: Manifold, plane: Plane | None) -> Manifold:
    return (
        hollowable_volume
        if plane is None
        else hollowable_volume.trim_by_plane(plane.normal, plane.offset_mm)
    )


def _holds_ball(piece: Manifold, radius_mm: float) -> bool:
    """Whether a ball of this radius fits inside.

    A lattice is searched, coarse first, since most pieces are roomy; the deepest points of the
    finest, half a radius apart, are climbed from.
    """
    box = np.array(piece.bounding_box())
    extents = box[3:] - box[:3]
    if np.any(extents < 2 * radius_mm):
        return False
    surface = Surface.of(piece)
    finest = radius_mm / 2
    step = max(finest, float(extents.max()) / COARSE_CELLS)
    while True:
        points = _lattice(box, step)
        depth = surface.depth_mm(points)
        if depth.max() >= radius_mm:
            return True
        if step <= finest:
            break
        step = max(finest, step / 2)
    starts = points[np.argsort(-depth, kind="stable")[:STARTS]]
    _, deepest = deepest_points(surface.depth_mm, starts, finest, radius_mm)
    return bool(deepest.max() >= radius_mm)


def _lattice(box: Float, step_mm: float) -> Float:
    """(n, 3) points in a box, a step apart, half a step from its lower corner."""
    axes = [np.arange(box[axis] + step_mm / 2, box[axis + 3], step_mm) for axis in range(3)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
