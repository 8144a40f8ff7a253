"""Finds places where a part is thinner than a limit, and gaps narrower than a limit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.quantize import quantized_arrays
from printprep.thickness.local import LocalThickness, local_thickness, perpendiculars

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float

# One point per square millimetre, but not fewer or more than this.
_FEWEST, _MOST = 5_000, 60_000
# Sides farther from parallel than this are an edge or a crease, not a wall or a gap: at an edge of
# 30° material thinner than 1.2 mm is a strip of 2 mm, and nothing breaks.
_TAPER_DEG = 30.0
# Chords through the middle of a thin place, at right angles to the direction across.
_CHORDS = 6


@dataclass(frozen=True, eq=False)
class Thin:
    """Thin places or gaps, each of the same area of surface.

    middle : (k, 3) mm, half way across;  thick_mm : (k,) distance across;
    wide_mm : (k,) shortest chord through the middle at right angles to that direction;
    area_mm2 : area of surface of each place.
    """

    middle: Float
    thick_mm: Float
    wide_mm: Float
    area_mm2: float

    def __len__(self) -> int:
        return len(self.thick_mm)

    @property
    def total_mm2(self) -> float:
        """Area of surface of all places."""
        return len(self) * self.area_mm2

    def only(self, which: Bool) -> Thin:
        """The places that are True in which (k,)."""
        return Thin(self.middle[which], self.thick_mm[which], self.wide_mm[which], self.area_mm2)

    def patches(self, link_mm: float) -> list[Thin]:
        """The places in groups: places closer than ``link_mm`` belong to one group."""
        if not len(self):
            return []
        from scipy.sparse.csgraph import connected_components
        from scipy.spatial import cKDTree

        tree = cKDTree(self.middle)
        count, group = connected_components(tree.sparse_distance_matrix(tree, link_mm).tocsr())
        return [self.only(group == number) for number in range(count)]

    @property
    def thinnest(self) -> tuple[float, tuple[float, float, float]]:
        """The least thickness, and its place (x, y, z)."""
        least = int(np.argmin(self.thick_mm))
        x, y, z = self.middle[least].tolist()
        return float(self.thick_mm[least]), (x, y, z)


def thin_places(part: Manifold, limit_mm: float) -> Thin:
    """Places where material between nearly parallel sides is thinner than a limit."""
    found = _mapped(part, limit_mm, gaps=False)
    middle, across, thick = _below(found, limit_mm)
    surface, wide = tree_of(*quantized_arrays(part)), np.full(len(middle), np.inf)
    first, second = perpendiculars(across) if len(across) else (across, across)
    for turn in np.arange(_CHORDS) * (np.pi / _CHORDS):
        along = np.cos(turn) * first + np.sin(turn) * second
        chord = surface.first_hit(middle, along)[0] + surface.first_hit(middle, -along)[0]
        wide = np.minimum(wide, chord)
    return Thin(middle, thick, wide, found.area_mm2)


def gap_places(part: Manifold, limit_mm: float) -> Thin:
    """Places where the space outside, between nearly parallel sides, is narrower than a limit.

    They include sides that meet, as where a ball lies on a plate: there the gap tapers to nothing.
    """
    found = _mapped(part, limit_mm, gaps=True)
    middle, _, thick = _below(found, limit_mm)
    return Thin(middle, thick, np.full(len(thick), np.inf), found.area_mm2)


def _mapped(part: Manifold, limit_mm: float, *, gaps: bool) -> LocalThickness:
    return local_thickness(
        *quantized_arrays(part),  # in one order, whatever made the part: the same points
        samples=int(np.clip(part.surface_area(), _FEWEST, _MOST)),
        at_most_mm=1.01 * limit_mm,
        gaps=gaps,
        taper_deg=_TAPER_DEG,
    )


def _below(found: LocalThickness, limit_mm: float) -> tuple[Float, Float, Float]:
    """(k, 3) mm, middles, (k, 3) unit vectors across, and (k,) mm, thickness below the limit."""
    thin = (found.ball_mm < limit_mm) & np.isfinite(found.across[:, 0])
    chord = found.across[thin] - found.points[thin]
    length = np.linalg.norm(chord, axis=1, keepdims=True)
    unit = np.divide(chord, length, out=-found.normals[thin], where=length > 0)
    return found.points[thin] + chord / 2, unit, found.ball_mm[thin]
