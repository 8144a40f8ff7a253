"""Contact of a print with the bed: the beads of its lowest layer and the area they cover."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs
from printprep.grid.cell_distance import cell_distance
from printprep.stand.contact import Contact, contact_of

if TYPE_CHECKING:
    from manifold3d import CrossSection

    from printprep.arrays import Float


_TILE = 256  # outlines united at a time: the work grows faster than their number
_HULL_TILE = 1 << 16
_TANGLED_FROM = 10_000  # beads; with fewer, crossings cost no time that matters
_TANGLED_TIMES = 3.0  # beads of a first layer cover their area about once
_COARSE_GRID, _FINE_GRID = 512, 2048  # cells along a side
_SAMPLES_MAX = 1 << 22
SAME_LAYER_MM = 1e-3  # G-code has three decimals
_REPEATS_FROM = 1 << 17  # beads, before which repeats are not looked for
_ROUND = 16  # corners of the circle at the end of a bead: its area is 2.6 % too small


@dataclass
class LowestBeads:
    """The beads of one group on its lowest layer so far.

    beads : (n, 7) mm: x, y of the start, x, y of the end, z of the top, width, height.
    """

    z_mm: float = np.inf
    _beads: list[Float] = field(default_factory=list)
    _size: int = 0
    _unique: int = _REPEATS_FROM  # so many were left when repeats were last taken out

    def add(self, beads: Float) -> None:
        """Add beads (k, 7) of a piece of the file; only those on the lowest layer are kept."""
        lowest = float(beads[:, 4].min())
        if lowest < self.z_mm - SAME_LAYER_MM:
            self._beads.clear()
            self._size, self._unique = 0, _REPEATS_FROM
            self.z_mm = lowest
        kept = beads[beads[:, 4] <= self.z_mm + SAME_LAYER_MM]
        if len(kept):
            self._beads.append(kept)
            self._size += len(kept)
            if self._size > 2 * self._unique:
                self._beads = [np.unique(self.beads, axis=0)]
                self._size = len(self._beads[0])
                self._unique = max(self._size, _REPEATS_FROM)

    @property
    def count(self) -> int:
        """How many they are; those that repeat count at most once from time to time."""
        return self._size

    @property
    def beads(self) -> Float:
        """(n, 7) all of them."""
        return np.concatenate(self._beads) if self._beads else np.zeros((0, 7))


def contact_of_beads(beads: Float) -> Contact | None:
    """The contact that beads (n, 7) make with the bed, None where it is too small to stand on.

    Where many beads cross each other, as no slicer prints, the area is counted on a grid; it is
    then right to about half a bead's width along its outline.
    """
    if not len(beads):
        return None
    beads = np.unique(beads, axis=0)  # sorted, so that neighbours share a tile; without repeats
    length = np.linalg.norm(beads[:, 2:4] - beads[:, :2], axis=1)
    if len(beads) > _TANGLED_FROM:
        drawn = float((length * beads[:, 5]).sum())
        if drawn > _TANGLED_TIMES * _counted_area(beads, length, _COARSE_GRID):
            return Contact(_hull_of(beads), _counted_area(beads, length, _FINE_GRID))
    return contact_of(union_of(beads))


def _hull_of(beads: Float) -> Float:
    """(k, 2) mm, counter-clockwise, the convex hull of the outlines of beads (n, 7)."""
    from scipy.spatial import ConvexHull

    corners = np.zeros((0, 2))
    for some in np.array_split(beads, len(beads) // _HULL_TILE + 1):
        points = np.concatenate([corners, _outlines(some).reshape(-1, 2)])
        corners = points[ConvexHull(points).vertices]
    return corners


def _counted_area(beads: Float, length: Float, cells: int) -> float:
    """Area that beads (n, 7), length (n,), cover: of cells near their axes.

    cells : of the grid, along its longer side, at most.
    """
    half = float(np.median(beads[:, 5])) / 2
    low = np.minimum(beads[:, :2], beads[:, 2:4]).min(axis=0) - half
    extent = np.maximum(beads[:, :2], beads[:, 2:4]).max(axis=0) + half - low
    pitch = max(half / 2, float(extent.max()) / cells)
    away = np.ones(np.ceil(extent / pitch).astype(np.int64) + 1, dtype=bool)
    samples = np.ceil(length / pitch).astype(np.int64) + 1
    parts = np.flatnonzero(np.diff(np.cumsum(samples) // _SAMPLES_MAX, prepend=0))
    for some in np.split(np.arange(len(beads)), parts):
        owner, step = runs(samples[some])
        share = (step / np.maximum(samples[some][owner] - 1, 1))[:, None]
        points = beads[some, :2][owner] * (1 - share) + beads[some, 2:4][owner] * share
        i, j = np.floor((points - low) / pitch).astype(np.int64).T
        away[i, j] = False
    near = cell_distance(away) * pitch <= half
    return float(near.sum()) * pitch**2


def union_of(beads: Float) -> CrossSection:
    """The region that beads (n, 7) cover: each axis widened by half the width, with round ends."""
    from manifold3d import CrossSection, FillRule, OpType

    outlines = _outlines(beads)
    tiles = [
        CrossSection(list(some), FillRule.NonZero)
        for some in np.array_split(outlines, max(1, len(outlines) // _TILE))
    ]
    return CrossSection.batch_boolean(tiles, OpType.Add)


def _outlines(beads: Float) -> Float:
    """(n, k, 2) mm, the outlines of beads (n, 7), counter-clockwise."""
    a, b, half = beads[:, :2], beads[:, 2:4], beads[:, 5] / 2
    along = b - a
    heading = np.arctan2(along[:, 1], along[:, 0])
    corners = (np.arange(_ROUND // 2 + 1) / (_ROUND // 2) - 0.5) * np.pi
    ends = []
    for centre, turn in ((b, 0.0), (a, np.pi)):
        angle = heading[:, None] + corners[None, :] + turn
        circle = half[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
        ends.append(centre[:, None, :] + circle)
    return np.concatenate(ends, axis=1)
