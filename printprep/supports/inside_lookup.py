"""Quick answers to what is inside the hollowable volume, from vertical lines on a fine lattice.

The line nearest to a point answers for it, so answers near steep walls are off by up to 0.71
lattice steps sideways.  Callers keep that much away, and the finished cavity is judged exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.mesh.winding_columns import crossings_of

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

LOOKUP_MM = 0.35
# The lattice avoids round numbers, where meshes have their edges.
_JITTER = (0.3819660113, 0.6180339887)


@dataclass(frozen=True, eq=False)
class InsideLookup:
    """The crossings of vertical lines with the surface of a volume.

    low_mm : (2,) mm, x and y of line (0, 0);  step_mm : between lines;  shape : lines along x, y.
    keys : (n,) sorted, one for each crossing: line number times ``span_mm`` plus height above
    ``floor_mm``.
    """

    low_mm: Float
    step_mm: float
    shape: tuple[int, int]
    keys: Float
    floor_mm: float
    span_mm: float

    @staticmethod
    def of(hollowable_volume: Manifold, step_mm: float) -> InsideLookup:
        """Cross the volume with lines ``step_mm`` apart."""
        vertices, faces = arrays(hollowable_volume)
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        corner = low[:2] + step_mm * (np.array(_JITTER) - 1)
        nx, ny = (np.ceil((high[:2] - corner) / step_mm).astype(int) + 1).tolist()
        x, y = (corner[k] + step_mm * np.arange(n) for k, n in enumerate((nx, ny)))
        columns = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        hits = crossings_of(vertices, faces, columns)
        span = float(high[2] - low[2]) + 2.0
        keys = hits.column * span + (hits.z_mm - low[2] + 1.0)
        return InsideLookup(corner, step_mm, (nx, ny), keys, float(low[2]) - 1.0, span)

    def contains(self, points: Float) -> Bool:
        """(…,) whether points (…, 3) mm lie in the volume."""
        _, crossed, valid = self._sought(points)
        result: Bool = valid & (crossed % 2 == 1)
        return result

    def headroom_mm(self, points: Float) -> Float:
        """(…,) mm, how far the volume reaches down below points (…, 3) mm; 0 outside it."""
        key, crossed, valid = self._sought(points)
        below = self.keys[np.maximum(crossed - 1, 0)]
        return np.where(valid & (crossed % 2 == 1), key - below, 0.0)

    def _sought(self, points: Float) -> tuple[Float, Int, Bool]:
        """Keys (…,) of points (…, 3) mm, crossings (…,) before each, and whether (…,) it is on the
        lattice."""
        column, height = self.nearest(points[..., :2]), points[..., 2] - self.floor_mm
        valid = (column >= 0) & (height > 0) & (height < self.span_mm)
        key = np.where(valid, column * self.span_mm + height, -1.0)
        return key, np.searchsorted(self.keys, key), valid

    def nearest(self, places: Float) -> Int:
        """(…,) numbers of the lines nearest to places (…, 2) mm, −1 beyond the lattice."""
        found = np.rint((places - self.low_mm) / self.step_mm).astype(np.int64)
        i, j = found[..., 0], found[..., 1]
        valid = (i >= 0) & (i < self.shape[0]) & (j >= 0) & (j < self.shape[1])
        result: Int = np.where(valid, i * self.shape[1] + j, -1)
        return result

    def at_heights(self, z_mm: Float) -> Bool:
        """(lines + 1, n) whether each line is in the volume at heights (n,) mm, upward.

        The last row, number −1, stands for all beyond the lattice.
        """
        column = np.floor(self.keys / self.span_mm).astype(np.int64)
        above = self.keys - column * self.span_mm
        crossed = np.zeros((self.shape[0] * self.shape[1] + 1, len(z_mm) + 1), dtype=np.uint8)
        first = np.searchsorted(z_mm - self.floor_mm, above, side="right")
        np.bitwise_xor.at(crossed, (column, first), 1)
        inside = np.bitwise_xor.accumulate(crossed, axis=1)[:, :-1]
        return inside.astype(bool)
