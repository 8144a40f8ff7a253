"""The wall between cavities and the outside, measured on the finished surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from printprep.mesh.measure import arrays

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


class Walled(Protocol):
    """Anything with an outside and cavities: a Part, a Subject."""

    @property
    def outside(self) -> Manifold: ...
    @property
    def cavities(self) -> Sequence[Manifold]: ...


class Wall(NamedTuple):
    """The thinnest wall: its thickness, and a place near its middle (x, y, z)."""

    value_mm: float
    at_mm: tuple[float, float, float]


def wall_min_mm(part: Walled) -> Wall | None:
    """The thinnest wall between the cavities and the outside; None without a cavity.

    The place comes from vertices and face centres of each surface against the other mesh.  The
    thickness is then the exact least distance between the two triangle meshes, which two edges
    that cross can make smaller than any vertex tells; 0 where a cavity breaks through.
    """
    if not part.cavities:
        return None
    cavity = united(part.cavities)
    outer, inner = arrays(part.outside), arrays(cavity)
    there, back = _nearest(inner, outer), _nearest(outer, inner)
    sampled, middle = min(there, back, key=lambda found: found[0])
    # Beyond the outside, as a solid: the gap between it and the cavity is the wall.
    low, high = np.reshape(part.outside.bounding_box(), (2, 3))
    margin = 1.0 + float((high - low).max())
    beyond = _box(low - margin, high + margin) - part.outside
    exact = float(beyond.min_gap(cavity, sampled * (1 + 1e-9) + 1e-9))
    x, y, z = middle.tolist()
    return Wall(min(exact, sampled), (x, y, z))


def _nearest(of: tuple[Float, Int], to: tuple[Float, Int]) -> tuple[float, Float]:
    """Least distance from vertices and face centres of one mesh to the other, and the midpoint."""
    import igl

    vertices, faces = of
    points = np.ascontiguousarray(np.concatenate([vertices, vertices[faces].mean(axis=1)]))
    squared, _, nearest = igl.point_mesh_squared_distance(points, *to)
    least = int(np.argmin(squared))
    return float(np.sqrt(max(squared[least], 0.0))), (points[least] + nearest[least]) / 2


def _box(low: Float, high: Float) -> Manifold:
    from manifold3d import Manifold

    return Manifold.cube((high - low).tolist()).translate(low.tolist())


def united(solids: Sequence[Manifold]) -> Manifold:
    """The union of solids, empty for none."""
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(list(solids), OpType.Add) if solids else Manifold()
