"""Cut the cavity along the planes, leave out what is too small, and subtract it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.written import as_written
from printprep.mesh.measure import bodies
from printprep.types import Base, Part, Plane, Solid
from printprep.voxel.balls import deepest_point
from printprep.voxel.distance import Surface

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    Float = NDArray[np.float64]

# Where a search for the largest ball starts: as many of the points farthest from the surface.
STARTS = 8


def cut(
    room: Manifold, parts: Sequence[Manifold], planes: Sequence[Plane | None]
) -> Manifold:
    """What of the room for cavities lies above the plane of its body; one plane for each part."""
    from manifold3d import Manifold, OpType

    if len(parts) == 1:
        return _above(room, planes[0])
    pieces = [
        _above(room ^ body, plane) for body, plane in zip(parts, planes, strict=True)
    ]
    return Manifold.batch_boolean(pieces, OpType.Add)


def cavities_of(room: Manifold, min_feature_mm: float) -> tuple[Manifold, ...]:
    """The pieces of a cavity that can hold a ball of the minimum feature, largest first."""
    pieces = [piece for piece in bodies(room) if _holds_ball(piece, min_feature_mm / 2)]
    return tuple(sorted(pieces, key=lambda piece: (-piece.volume(), piece.bounding_box())))


def make_part(solid: Solid, base: Base | None, cavities: Sequence[Manifold]) -> Part:
    """Unite the solid with its base and subtract the cavities, in the coordinates of a file."""
    from manifold3d import Manifold, OpType

    outside = solid.manifold if base is None else solid.manifold + base.manifold
    whole = Manifold.batch_boolean([outside, *cavities], OpType.Subtract)
    part = as_written(whole)
    return Part(part, outside, tuple(cavities), base, solid.name, solid.placement)


def _above(room: Manifold, plane: Plane | None) -> Manifold:
    return room if plane is None else room.trim_by_plane(plane.normal, plane.offset_mm)


def _holds_ball(piece: Manifold, radius_mm: float) -> bool:
    """Whether a ball of this radius fits inside."""
    box = np.array(piece.bounding_box())
    if np.any(box[3:] - box[:3] < 2 * radius_mm):
        return False
    surface = Surface.of(piece)
    step = radius_mm / 2
    starts = _inner_points(surface, box, step)
    for start, depth in starts:
        if depth >= radius_mm:
            return True
        _, deepest = deepest_point(surface.depth_mm, start, step)
        if deepest >= radius_mm:
            return True
    return False


def _inner_points(surface: Surface, box: Float, step_mm: float) -> list[tuple[Float, float]]:
    """Some inner points with their depth, deepest first, from a lattice of the given step.

    A piece that holds a ball of radius 2·step has lattice points well inside it.  Large pieces are
    searched in chunks, from their middle out, until one is deep enough to settle the matter.
    """
    axes = [np.arange(low + step_mm / 2, high, step_mm) for low, high in zip(box[:3], box[3:])]
    lattice = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    order = np.argsort(np.linalg.norm(lattice - (box[:3] + box[3:]) / 2, axis=1), kind="stable")
    found: list[tuple[Float, float]] = []
    for chunk in np.array_split(lattice[order], max(1, len(lattice) // 20000)):
        depth = surface.depth_mm(chunk)
        top = np.argsort(-depth, kind="stable")[:STARTS]
        found += [(chunk[i], float(depth[i])) for i in top if depth[i] > 0]
        if found and max(d for _, d in found) >= 2 * step_mm:
            break
    return sorted(found, key=lambda pair: -pair[1])[:STARTS]

