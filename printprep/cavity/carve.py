"""Cut the cavity along the planes, drop pieces that are too small, and subtract the rest."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.balls import deepest_points
from printprep.grid.distance import Surface
from printprep.mesh.measure import bodies
from printprep.mesh.quantize import quantized
from printprep.mesh.sealed_voids import sealed_voids
from printprep.mesh.shell_figures import pieces, without_crumbs
from printprep.types import Base, Part, Plane, Solid

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float


# A search for the largest ball starts from so many of the deepest points.
STARTS = 8
# Points along the longest side of the first lattice that is searched for a ball.
COARSE_CELLS = 12


def cut(
    hollowable_volume: Manifold, parts: Sequence[Manifold], planes: Sequence[Plane | None]
) -> Manifold:
    """Keep the hollowable volume above the plane of its body.

    parts : the bodies of the solid;  planes : one for each of them, None where nothing is filled.
    """
    from manifold3d import Manifold, OpType

    if len(parts) == 1:
        return _above(hollowable_volume, planes[0])
    cuts = [
        _above(hollowable_volume ^ body, plane) for body, plane in zip(parts, planes, strict=True)
    ]
    return Manifold.batch_boolean(cuts, OpType.Add)


def cavities_of(cavity: Manifold, min_feature_mm: float) -> tuple[Manifold, ...]:
    """Pieces of a cavity that can hold a ball of the minimum feature, largest first.

    Material that floats in a piece is left out of the part: nothing would hold it.
    """
    large = pieces(cavity, ball_mm3(min_feature_mm))
    roomy = [piece for piece in large if _holds_ball(piece, min_feature_mm / 2)]
    return tuple(sorted(roomy, key=lambda piece: (-piece.volume(), piece.bounding_box())))


def ball_mm3(diameter_mm: float) -> float:
    """The volume of a ball."""
    return math.pi / 6 * diameter_mm**3


def make_part(
    solid: Solid, base: Base | None, cavities: Sequence[Manifold], crumb_mm3: float = 0.0
) -> Part:
    """Unite the solid with its base and subtract the cavities; finished as it will be written."""
    return finished(rough_part(solid, base, cavities), crumb_mm3)


def rough_part(solid: Solid, base: Base | None, cavities: Sequence[Manifold]) -> Part:
    """The same part, not yet finished.

    The voids of the model that stay are cavities like those that are cut.
    """
    from manifold3d import Manifold, OpType

    outside = solid.whole if base is None else _on_base(solid.whole, base.manifold)
    voids = (*cavities, *solid.kept)
    whole = Manifold.batch_boolean([outside, *voids], OpType.Subtract)
    return Part(whole, outside, voids, base, solid.name, solid.placement, solid.kept)


def _on_base(solid: Manifold, base: Manifold) -> Manifold:
    """The solid with its base; what the base closes off from the air is filled."""
    return sealed_voids(solid + base).whole


def finished(part: Part, crumb_mm3: float) -> Part:
    """A part as it will be written: without the crumbs of its booleans, rounded to float32."""
    rounded = quantized(without_crumbs(part.manifold, crumb_mm3)[0])
    return replace(part, manifold=_touching_joined(rounded))


def _touching_joined(part: Manifold) -> Manifold:
    """The part with bodies that touch once they are rounded as one, as programs read them."""
    from manifold3d import Manifold, OpType

    apart = bodies(part)
    if len(apart) == 1:
        return part
    joined = Manifold.batch_boolean(list(apart), OpType.Add)
    return quantized(joined) if len(bodies(joined)) < len(apart) else part


def _above(hollowable_volume: Manifold, plane: Plane | None) -> Manifold:
    return (
        hollowable_volume
        if plane is None
        else hollowable_volume.trim_by_plane(plane.normal, plane.offset_mm)
    )


def _holds_ball(piece: Manifold, radius_mm: float) -> bool:
    """Whether a ball of this radius fits inside.

    The search takes a coarse lattice first, since most pieces are wide.  It climbs from the deepest
    points of the finest lattice, whose points are half a radius apart.
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
    """(n, 3) mm, points in a box, a step apart, half a step from its lower corner; never none.

    box : (6,) mm, lower and upper corner.  Where it is narrower than a step they lie in its middle.
    """
    first = box[:3] + np.minimum(step_mm, box[3:] - box[:3]) / 2
    axes = [np.arange(first[axis], box[axis + 3], step_mm) for axis in range(3)]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
