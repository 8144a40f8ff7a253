"""Local thickness of a solid at points of its surface, by ball and by ray, and of gaps likewise.

Notation: p a point of the surface, n the unit normal out of the material (into it, for gaps),
c = p − R n the centre of a ball that touches the surface at p from within, q where it touches
again, m the normal there, θ the angle at the centre between p and q.

The ball through p that also passes through q has the radius

    R(q) = |p − q|² / (2 n · (p − q)).

A wall lies between two sides that face each other, so the thickness at p is 2R for the largest
ball that no q with θ ≥ 180° − τ cuts into: q no farther than τ/2 from straight across, and the side
it lies on turned by no more than τ from parallel.  Without that bound every convex edge, and every
facet of a curved surface, would count as thin (the ball in a cube's edge touches two faces at 90°);
with it a wedge is thin toward its edge where it is sharper than τ, 60° unless said otherwise.

Found by shrinking balls (Ma, Bae and Choi, "3D medial axis point approximation using nearest
neighbors and the normal field", 2012), on triangles instead of a cloud of points.  Where what lies
nearest to the centre is not across, rays straight and aslant look for what is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

TAPER_DEG = 60.0
# Rays aslant, so many around the normal and so far from it, as a share of τ.
_SLANT, _SLANTS = 1 / 3, 6
_ROUNDS = 30
_EXACT = 1e-6  # a ball is done when nothing reaches deeper into it than this share of R


@dataclass(frozen=True, eq=False)
class LocalThickness:
    """Thickness at points spread evenly over a surface.

    points, normals : (n, 3) mm, normals out of what is measured;  area_mm2 : that each stands for.
    ball_mm : (n,) diameter of the ball, at most the bound that was asked for.
    ray_mm : (n,) straight across to a side that faces this one; inf where there is none, and
        where a bound made it unnecessary.
    across : (n, 3) where the ball touches the other side, NaN where it does not.
    """

    points: Float
    normals: Float
    area_mm2: float
    ball_mm: Float
    ray_mm: Float
    across: Float

    def percentile_mm(self, percent: float) -> float:
        """Thickness that so many percent of the area fall below."""
        return float(np.percentile(self.ball_mm, percent, method="inverted_cdf"))


def local_thickness(
    vertices: Float,
    faces: Int,
    *,
    samples: int = 20_000,
    at_most_mm: float = np.inf,
    gaps: bool = False,
    taper_deg: float = TAPER_DEG,
) -> LocalThickness:
    """The thickness at points drawn evenly over a closed surface, always the same ones.

    Parameters
    ----------
    vertices, faces : (n, 3) mm and (m, 3), counter-clockwise seen from outside.
    samples : how many points; they stand for equal areas.
    at_most_mm : what is thicker is reported as this: most points are then done at one look.
    gaps : measure the empty space in front of the surface instead of the material behind it.
    taper_deg : τ, how far from parallel the two sides may be.
    """
    points, normals, area = _spread(vertices, faces, samples)
    facets = _normals(vertices, faces)
    if gaps:
        normals, facets = -normals, -facets
    look = _Look(
        SurfaceTree(vertices, faces), facets, points, normals, float(np.radians(taper_deg))
    )
    everything = np.arange(len(points))
    bound = min(at_most_mm, float(np.ptp(vertices, axis=0).max()))
    ball = _Balls.of(len(points), bound / 2)
    ray = np.full(len(points), np.inf)
    if at_most_mm > bound:
        ray = look.along(everything, -normals, ball)
    blocked = look.shrink(everything, ball)
    straight = look.along(blocked, -normals[blocked], ball)
    ray[blocked] = straight
    look.aslant(blocked, ball)
    return LocalThickness(points, normals, area, 2 * ball.radius, ray, ball.across)


@dataclass(frozen=True, eq=False)
class _Balls:
    """Radius (n,) of the ball at every point, and (n, 3) where it touches across; both change."""

    radius: Float
    across: Float

    @staticmethod
    def of(count: int, radius_mm: float) -> _Balls:
        return _Balls(np.full(count, radius_mm), np.full((count, 3), np.nan))

    def shrunk(self, which: Int, radius: Float, across: Float) -> None:
        """Take the balls that are smaller."""
        smaller = radius < self.radius[which]
        self.radius[which[smaller]] = radius[smaller]
        self.across[which[smaller]] = across[smaller]


@dataclass(frozen=True, eq=False)
class _Look:
    """Points (n, 3) with normals, the surface with the normals (m, 3) of its faces, and τ."""

    surface: SurfaceTree
    facets: Float
    points: Float
    normals: Float
    taper: float

    def shrink(self, which: Int, balls: _Balls) -> Int:
        """Shrink balls until nothing lies in them; what stops at a place not across is returned.

        Such balls are left as they were.
        """
        radius, going = balls.radius.copy(), which
        voxelize_surface = np.full(self.points.shape, np.nan)
        blocked = np.zeros(len(radius), dtype=bool)
        for _ in range(_ROUNDS):
            centre = self.points[going] - radius[going, None] * self.normals[going]
            distance, there = self.surface.nearest(centre)
            deep = distance < radius[going] * (1 - _EXACT)
            going, there = going[deep], there[deep]
            smaller, facing = self._radius(going, there)
            facing &= smaller < radius[going]
            blocked[going[~facing]] = True
            going = going[facing]
            radius[going], voxelize_surface[going] = smaller[facing], there[facing]
            if len(going) == 0:
                break
        done = which[~blocked[which] & np.isfinite(voxelize_surface[which, 0])]
        balls.shrunk(done, radius[done], voxelize_surface[done])
        return np.flatnonzero(blocked)

    def along(self, which: Int, ways: Float, balls: _Balls) -> Float:
        """Follow a ray from each point; how far it goes until it meets what faces the point."""
        far, face = self.surface.first_hit(self.points[which], ways)
        opposed = np.einsum("ij,ij->i", self.normals[which], self.facets[face])
        far = np.where((opposed <= -np.cos(self.taper)) & (face >= 0), far, np.inf)
        met = np.isfinite(far)
        chosen = which[met]
        there = self.points[chosen] + far[met, None] * ways[met]
        radius, facing = self._radius(chosen, there)
        balls.shrunk(chosen[facing], radius[facing], there[facing])
        return far

    def aslant(self, which: Int, balls: _Balls) -> None:
        """Follow rays aslant all around each point."""
        first, second = beside(self.normals[which])
        tilt = _SLANT * self.taper
        for turn in np.arange(_SLANTS) * (2 * np.pi / _SLANTS):
            side = np.cos(turn) * first + np.sin(turn) * second
            self.along(which, np.sin(tilt) * side - np.cos(tilt) * self.normals[which], balls)

    def _radius(self, which: Int, there: Float) -> tuple[Float, Bool]:
        """R(q), and whether q lies across."""
        way = self.points[which] - there
        length = np.linalg.norm(way, axis=1)
        along = np.einsum("ij,ij->i", self.normals[which], way)
        facing = along > np.cos(self.taper / 2) * length
        return length**2 / np.where(facing, 2 * along, 1.0), facing


def beside(ways: Float) -> tuple[Float, Float]:
    """Two unit vectors at right angles to each unit vector (n, 3) and to each other."""
    least = np.abs(ways).argmin(axis=1)
    first = np.cross(ways, np.eye(3)[least])
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(ways, first)


def _normals(vertices: Float, faces: Int) -> Float:
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    unit: Float = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    return unit


def _spread(vertices: Float, faces: Int, count: int) -> tuple[Float, Float, float]:
    """Points evenly over the area, their normals, and the area that each stands for."""
    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    cumulative = np.cumsum(doubled)
    rng = np.random.default_rng(0)
    at = (np.arange(count) + rng.random(count)) / count * cumulative[-1]
    face = np.minimum(np.searchsorted(cumulative, at, side="right"), len(faces) - 1)
    u, v = np.sqrt(rng.random(count)), rng.random(count)
    weights = np.stack([1 - u, u * (1 - v), u * v], axis=1)
    points = np.einsum("nk,nkj->nj", weights, corners[face])
    return points, normals[face] / doubled[face, None], float(cumulative[-1]) / 2 / count
