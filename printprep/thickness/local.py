"""Measures local thickness at points of a solid's surface, by ball and by ray, and gaps likewise.

Notation: p a point of the surface, n the unit normal out of the material (into it, for gaps),
c = p − R n the centre of a ball that touches the surface at p from within, q where it touches
again, m the normal there, θ the angle at the centre between p and q.

The ball through p that also passes through q has the radius

    R(q) = |p − q|² / (2 n · (p − q)).

A wall lies between two sides that face each other, so the thickness at p is 2R for the largest
ball that contains no q with θ ≥ 180° − τ: q lies at most τ/2 from straight across, on a side turned
by at most τ from parallel.  Without that limit every convex edge, and every facet of a curved
surface, would count as thin (the ball in a cube's edge touches two faces at 90°); with it a wedge
is thin toward its edge where it is sharper than τ, by default 60°.

The method is that of shrinking balls (Ma, Bae and Choi, "3D medial axis point approximation using
nearest neighbors and the normal field", 2012), on triangles instead of a cloud of points.  Where
the surface nearest to the centre does not lie across, straight and slanted rays look for the side
that does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree, tree_of
from printprep.mesh.measure import area_normals
from printprep.mesh.sample import points_on_surface

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

TAPER_DEG = 60.0
# Slanted rays: their angle from the normal, as a share of τ, and their number around it.
_SLANT, _SLANTS = 1 / 3, 6
_ROUNDS = 30
_EXACT = 1e-6  # a ball is final when the surface reaches no deeper into it than this share of R


@dataclass(frozen=True, eq=False)
class LocalThickness:
    """Thickness at points spread evenly over a surface.

    points : (k, 3) mm;  normals : (k, 3) unit vectors out of the measured material or gap;
    area_mm2 : area of surface around each point.
    ball_mm : (k,) diameter of the ball, at most the bound of the call.
    ray_mm : (k,) distance straight across to a side that faces this one; inf where there is none,
        and where the bound made it unnecessary.
    across : (k, 3) mm, where the ball touches the other side, NaN where it does not.
    """

    points: Float
    normals: Float
    area_mm2: float
    ball_mm: Float
    ray_mm: Float
    across: Float


def local_thickness(
    vertices: Float,
    faces: Int,
    *,
    samples: int = 20_000,
    at_most_mm: float = np.inf,
    gaps: bool = False,
    taper_deg: float = TAPER_DEG,
) -> LocalThickness:
    """The thickness at points spread evenly over a closed surface, always the same ones.

    Parameters
    ----------
    vertices, faces : (n, 3) mm and (m, 3), counter-clockwise seen from outside.
    samples : number of points; they stand for equal areas.
    at_most_mm : a greater thickness is reported as this: most points then need one query only.
    gaps : measure the empty space in front of the surface instead of the material behind it.
    taper_deg : τ, how far from parallel the two sides may be.
    """
    points, normals, area = _samples(vertices, faces, samples)
    facets = _unit_normals(vertices, faces)
    if gaps:
        normals, facets = -normals, -facets
    probe = _Probe(tree_of(vertices, faces), facets, points, normals, float(np.radians(taper_deg)))
    everything = np.arange(len(points))
    bound = min(at_most_mm, float(np.ptp(vertices, axis=0).max()))
    ball = _Balls.of(len(points), bound / 2)
    ray = np.full(len(points), np.inf)
    if at_most_mm > bound:
        ray = probe.along(everything, -normals, ball)
    blocked = probe.shrink(everything, ball)
    straight = probe.along(blocked, -normals[blocked], ball)
    ray[blocked] = straight
    probe.aslant(blocked, ball)
    return LocalThickness(points, normals, area, 2 * ball.radius, ray, ball.across)


@dataclass(frozen=True, eq=False)
class _Balls:
    """The ball at every point so far; the arrays change in place.

    radius : (k,) mm;  across : (k, 3) mm, where the ball touches the other side, NaN where it does
    not.
    """

    radius: Float
    across: Float

    @staticmethod
    def of(count: int, radius_mm: float) -> _Balls:
        return _Balls(np.full(count, radius_mm), np.full((count, 3), np.nan))

    def shrunk(self, which: Int, radius: Float, across: Float) -> None:
        """Take new balls where they are no larger: at points (j,), radii (j,), across (j, 3)."""
        smaller = radius <= self.radius[which]
        self.radius[which[smaller]] = radius[smaller]
        self.across[which[smaller]] = across[smaller]


@dataclass(frozen=True, eq=False)
class _Probe:
    """Measures at points of a surface.

    facets : (m, 3) unit normals of the faces;  points, normals : (k, 3);  taper : τ in radians.
    """

    surface: SurfaceTree
    facets: Float
    points: Float
    normals: Float
    taper: float

    def shrink(self, which: Int, balls: _Balls) -> Int:
        """Shrink the balls at points (j,) until no surface lies in them.

        Returns (b,) the points whose ball met a place that does not lie across; those balls are
        left as they were.
        """
        radius, going = balls.radius.copy(), which
        touched = np.full(self.points.shape, np.nan)
        blocked = np.zeros(len(radius), dtype=bool)
        for _ in range(_ROUNDS):
            centre = self.points[going] - radius[going, None] * self.normals[going]
            distance, closest = self.surface.nearest(centre)
            deep = distance < radius[going] * (1 - _EXACT)
            going, closest = going[deep], closest[deep]
            smaller, facing = self._radius(going, closest)
            facing &= smaller < radius[going]
            blocked[going[~facing]] = True
            going = going[facing]
            radius[going], touched[going] = smaller[facing], closest[facing]
            if len(going) == 0:
                break
        done = which[~blocked[which] & np.isfinite(touched[which, 0])]
        balls.shrunk(done, radius[done], touched[done])
        return np.flatnonzero(blocked)

    def along(self, which: Int, directions: Float, balls: _Balls) -> Float:
        """(j,) mm from points (j,) along directions (j, 3) to a side that faces them, else inf.

        The balls at these points shrink where this is closer.
        """
        far, face = self.surface.first_hit(self.points[which], directions)
        opposed = np.einsum("ij,ij->i", self.normals[which], self.facets[face])
        far = np.where((opposed <= -np.cos(self.taper)) & (face >= 0), far, np.inf)
        met = np.isfinite(far)
        chosen = which[met]
        across = self.points[chosen] + far[met, None] * directions[met]
        radius, facing = self._radius(chosen, across)
        balls.shrunk(chosen[facing], radius[facing], across[facing])
        return far

    def aslant(self, which: Int, balls: _Balls) -> None:
        """Shrink the balls at points (j,) by slanted rays all around the normal."""
        first, second = perpendiculars(self.normals[which])
        tilt = _SLANT * self.taper
        for turn in np.arange(_SLANTS) * (2 * np.pi / _SLANTS):
            side = np.cos(turn) * first + np.sin(turn) * second
            self.along(which, np.sin(tilt) * side - np.cos(tilt) * self.normals[which], balls)

    def _radius(self, which: Int, across: Float) -> tuple[Float, Bool]:
        """(j,) R(q) for points (j,) and places q (j, 3), and (j,) whether q lies across."""
        chord = self.points[which] - across
        length = np.linalg.norm(chord, axis=1)
        along = np.einsum("ij,ij->i", self.normals[which], chord)
        facing = along > np.cos(self.taper / 2) * length
        return length**2 / np.where(facing, 2 * along, 1.0), facing


def perpendiculars(directions: Float) -> tuple[Float, Float]:
    """(k, 3) and (k, 3) unit vectors at right angles to unit vectors (k, 3) and to each other."""
    least = np.abs(directions).argmin(axis=1)
    first = np.cross(directions, np.eye(3)[least])
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(directions, first)


def _unit_normals(vertices: Float, faces: Int) -> Float:
    """(m, 3) unit normals of faces (m, 3), zero for those without area; vertices : (n, 3)."""
    normals = area_normals(vertices[faces])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: Float = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    return unit


def _samples(vertices: Float, faces: Int, count: int) -> tuple[Float, Float, float]:
    """(count, 3) mm, points spread evenly over the area, (count, 3) unit normals, area of each."""
    rng = np.random.default_rng(0)
    found = points_on_surface(vertices, faces, (np.arange(count) + rng.random(count)) / count, rng)
    length = np.linalg.norm(found.area_normals, axis=1, keepdims=True)
    return found.points, found.area_normals / length, found.surface_mm2 / count
