"""Where a part is thinner than a limit, and where it comes closer to itself than another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import SurfaceTree
from printprep.mesh.measure import arrays
from printprep.thickness.local import LocalThickness, beside, local_thickness

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float

# One point a square millimetre, within these numbers.
_FEWEST, _MOST = 5_000, 60_000
# Sides farther from parallel than this are an edge or a crease, and no wall or gap: at an edge of
# 30° a layer of 1.2 mm loses 2 mm, and nothing breaks.
_TAPER_DEG = 30.0
# Chords through the middle of a thin place, at right angles to the way across.
_CHORDS = 6


@dataclass(frozen=True, eq=False)
class Thin:
    """Places of a surface, each standing for the same area.

    middle : (n, 3) mm, half way across;  thick_mm : (n,) across.
    wide_mm : (n,) the shortest way through the middle at right angles to that.
    area_mm2 : of surface that each place stands for.
    """

    middle: Float
    thick_mm: Float
    wide_mm: Float
    area_mm2: float

    def __len__(self) -> int:
        return len(self.thick_mm)

    @property
    def total_mm2(self) -> float:
        return len(self) * self.area_mm2

    def only(self, which: Bool) -> Thin:
        """Those places."""
        return Thin(self.middle[which], self.thick_mm[which], self.wide_mm[which], self.area_mm2)

    def patches(self, link_mm: float) -> list[Thin]:
        """The places in groups: what lies closer than this belongs together."""
        if not len(self):
            return []
        from scipy.sparse.csgraph import connected_components
        from scipy.spatial import cKDTree

        tree = cKDTree(self.middle)
        count, group = connected_components(tree.sparse_distance_matrix(tree, link_mm).tocsr())
        return [self.only(group == number) for number in range(count)]

    @property
    def thinnest(self) -> tuple[float, tuple[float, float, float]]:
        """Least thickness, and where."""
        least = int(np.argmin(self.thick_mm))
        x, y, z = self.middle[least].tolist()
        return float(self.thick_mm[least]), (x, y, z)


def thin_places(part: Manifold, limit_mm: float) -> Thin:
    """Where material is thinner than a limit between sides that are nearly parallel."""
    found = _mapped(part, limit_mm, gaps=False)
    middle, across, thick = _below(found, limit_mm)
    surface, wide = SurfaceTree(*arrays(part)), np.full(len(middle), np.inf)
    first, second = beside(across) if len(across) else (across, across)
    for turn in np.arange(_CHORDS) * (np.pi / _CHORDS):
        way = np.cos(turn) * first + np.sin(turn) * second
        chord = surface.first_hit(middle, way)[0] + surface.first_hit(middle, -way)[0]
        wide = np.minimum(wide, chord)
    return Thin(middle, thick, wide, found.area_mm2)


def gap_places(part: Manifold, limit_mm: float) -> Thin:
    """Where the space outside is narrower than a limit between nearly parallel sides.

    Sides that meet, as where a ball lies on a plate, are among them; they taper to nothing.
    """
    found = _mapped(part, limit_mm, gaps=True)
    middle, _, thick = _below(found, limit_mm)
    return Thin(middle, thick, np.full(len(thick), np.inf), found.area_mm2)


def _mapped(part: Manifold, limit_mm: float, *, gaps: bool) -> LocalThickness:
    return local_thickness(
        *arrays(part),
        samples=int(np.clip(part.surface_area(), _FEWEST, _MOST)),
        at_most_mm=1.01 * limit_mm,
        gaps=gaps,
        taper_deg=_TAPER_DEG,
    )


def _below(found: LocalThickness, limit_mm: float) -> tuple[Float, Float, Float]:
    """Middles, unit vectors across, and thickness of what is below the limit."""
    thin = (found.ball_mm < limit_mm) & np.isfinite(found.across[:, 0])
    way = found.across[thin] - found.points[thin]
    length = np.linalg.norm(way, axis=1, keepdims=True)
    unit = np.divide(way, length, out=-found.normals[thin], where=length > 0)
    return found.points[thin] + way / 2, unit, found.ball_mm[thin]
