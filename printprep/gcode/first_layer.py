"""Contact of a print with the bed: the beads of its lowest layer and the area they cover."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from manifold3d import CrossSection

    from printprep.arrays import Float


_TILE = 256  # outlines united at a time: the work grows faster than their number
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


def union_of(beads: Float) -> CrossSection:
    """The region that beads (n, 7) cover: each axis widened by half the width, with round ends."""
    from manifold3d import CrossSection, FillRule, OpType

    beads = np.unique(beads, axis=0)  # sorted, so that neighbours share a tile; without repeats
    a, b, half = beads[:, :2], beads[:, 2:4], beads[:, 5] / 2
    along = b - a
    heading = np.arctan2(along[:, 1], along[:, 0])
    corners = (np.arange(_ROUND // 2 + 1) / (_ROUND // 2) - 0.5) * np.pi
    ends = []
    for centre, turn in ((b, 0.0), (a, np.pi)):
        angle = heading[:, None] + corners[None, :] + turn
        circle = half[:, None, None] * np.stack([np.cos(angle), np.sin(angle)], axis=2)
        ends.append(centre[:, None, :] + circle)
    outlines = np.concatenate(ends, axis=1)
    tiles = [
        CrossSection(list(some), FillRule.NonZero)
        for some in np.array_split(outlines, max(1, len(outlines) // _TILE))
    ]
    return CrossSection.batch_boolean(tiles, OpType.Add)
