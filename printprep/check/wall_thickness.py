"""Rule: no wall between a cavity and the outside is thinner than the profile's."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol

import numpy as np

from printprep.check.registry import rule
from printprep.check.subject import united
from printprep.mesh.measure import arrays
from printprep.types import Finding

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.check.subject import Subject
    from printprep.profiles import Profile
    from printprep.types import Float, Int

TOLERANCE_MM = 0.05


class Walled(Protocol):
    """Anything with an outside and cavities: a Part, a Subject."""

    @property
    def outside(self) -> Manifold: ...
    @property
    def cavities(self) -> Sequence[Manifold]: ...


class Wall(NamedTuple):
    """The thinnest wall: its thickness, and a place near its middle (x, y, z)."""

    thickness_mm: float
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


@rule("wall-thickness")
def wall_thickness(subject: Subject, profile: Profile) -> Iterator[Finding]:
    """Prevents a wall that prints with holes, or breaks when the part is touched.

    Measured on the finished surfaces, not assumed from the field they were cut from.
    """
    wall = wall_min_mm(subject)
    if wall is None or wall.thickness_mm >= profile.wall_mm - TOLERANCE_MM:
        return
    if subject.hollowed:
        fix = "Hollow it with a finer grid (--resolution), or report the model as a defect."
    else:
        fix = "Hollow the solid model again with this wall, or name the wall meant with --wall."
    yield Finding(
        "wall-thickness",
        "error",
        f"The thinnest wall between a cavity and the outside is {wall.thickness_mm:.2f} mm, "
        f"the profile asks for {profile.wall_mm:g} mm.",
        fix,
        value=wall.thickness_mm,
        limit=profile.wall_mm,
        unit="mm",
        at_mm=wall.at_mm,
    )
