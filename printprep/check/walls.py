"""The wall between cavities and the outside, measured on the finished surfaces."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.gap import gap_mm
from printprep.mesh.measure import arrays
from printprep.mesh.quantize import quantized_arrays

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Float, Int


# The corners of a face whose edges are shorter than this stand for its centre.
SMALL_MM = 0.5


class Walled(Protocol):
    """Anything with an outside and cavities: a Part or a CheckContext."""

    @property
    def outside(self) -> Manifold: ...
    @property
    def cavities(self) -> Sequence[Manifold]: ...


class Enclosed(NamedTuple):
    """A solid, and cavities in it."""

    outside: Manifold
    cavities: tuple[Manifold, ...]


class Wall(NamedTuple):
    """The thinnest wall: its thickness, and a point (x, y, z) near its middle."""

    value_mm: float
    at_mm: tuple[float, float, float]


def wall_min_mm(part: Walled) -> Wall | None:
    """The thinnest wall between the cavities and the outside; None without a cavity.

    The point comes from the vertices of each mesh, the centres of its faces that are not small, and
    the nearest point of the other.  The thickness is the exact least distance between the two
    triangle meshes: where two edges cross, it is smaller than at any vertex.  It is 0 where a
    cavity breaks through.
    """
    if not part.cavities:
        return None
    cavity = united(part.cavities)
    outer, inner = quantized_arrays(part.outside), arrays(cavity)
    outward, inward = _nearest(inner, outer), _nearest(outer, inner)
    sampled, middle = min(outward, inward, key=lambda nearest: nearest[0])
    exact = gap_mm(part.outside, cavity, sampled * (1 + 1e-9) + 1e-9)
    x, y, z = middle.tolist()
    return Wall(min(exact, sampled), (x, y, z))


def _nearest(of: tuple[Float, Int], to: tuple[Float, Int]) -> tuple[float, Float]:
    """Least distance in mm from vertices and face centres of one mesh to another; its midpoint.

    of, to : (n, 3) vertices in mm and (m, 3) faces each.  The midpoint is (3,) mm.
    """
    vertices, faces = of
    a, b, c = (vertices[corner] for corner in faces.T)
    longest = np.maximum.reduce([((p - q) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))])
    large = longest > SMALL_MM**2
    points = np.concatenate([vertices, (a + b + c)[large] / 3])
    distance, nearest = tree_of(*to).nearest(points)
    least = int(np.argmin(distance))
    return float(distance[least]), (points[least] + nearest[least]) / 2


def united(solids: Sequence[Manifold]) -> Manifold:
    """The union of solids, empty for none."""
    from manifold3d import Manifold, OpType

    return Manifold.batch_boolean(list(solids), OpType.Add) if solids else Manifold()
