"""What space a mesh encloses, however broken it is: the yardstick each rung of repair is held to.

The generalized winding number w is sampled once per cell of a jittered grid.  {w > ½} is the
solid meant.  Where ¼ < w < ¾ the surface is open and how to close it is a matter of choice;
elsewhere the mesh has decided, and a repair must agree with it.

Error of the sampled volume: only cells the surface crosses count, each with a standard deviation
of at most half a cell.  A surface of area A crosses about 3A/2h² cells of edge h (the mean of
|n_x| + |n_y| + |n_z| over directions is 3/2), so σ ≤ ½ h³ √(3A/2h²).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, winding

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    Float = NDArray[np.float64]
    Int = NDArray[np.int64]

_SAMPLES = 48**3
_SEED = 20130721
_UNDECIDED = (0.25, 0.75)
# Material two descriptions of one solid may differ by.  Half a percent is a tenth of what the
# flow of a filament printer varies by, and more than any closed model here deviates (0.06 %).
_SHARE = 0.005
_SIGMAS = 4.0


@dataclass(frozen=True, eq=False)
class Reference:
    """points : (n, 3) mm;  winding : (n,);  cell_mm3 : volume each point stands for;
    volume_mm3 : of {w > ½};  undecided_mm3 : of {¼ < w < ¾};  sigma_mm3 : bound on the standard
    deviation of ``volume_mm3``."""

    points: Float
    winding: Float
    cell_mm3: float
    volume_mm3: float
    undecided_mm3: float
    sigma_mm3: float

    @staticmethod
    def of(vertices: Float, faces: Int) -> Reference:
        """Sample a mesh: vertices (n, 3) mm, faces (m, 3)."""
        points, cell = _jittered(vertices)
        w = winding(points, vertices, faces)
        corners = vertices[faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        area = float(np.linalg.norm(normals, axis=1).sum()) / 2
        low, high = _UNDECIDED
        return Reference(
            points=points,
            winding=w,
            cell_mm3=cell,
            volume_mm3=float((w > 0.5).sum()) * cell,
            undecided_mm3=float(((w > low) & (w < high)).sum()) * cell,
            sigma_mm3=0.5 * cell ** (2 / 3) * float(np.sqrt(1.5 * area)),
        )

    def disagreement(self, manifold: Manifold, slack_mm3: float = 0.0) -> str | None:
        """Why a solid is not what the mesh encloses, or None when it is.

        slack_mm3 : volume the rung's own method may lose (0 for exact ones).
        """
        w = winding(self.points, *arrays(manifold))
        limit = _SHARE * self.volume_mm3 + slack_mm3
        decided = (self.winding <= _UNDECIDED[0]) | (self.winding >= _UNDECIDED[1])
        differs = float((decided & ((w > 0.5) != (self.winding > 0.5))).sum()) * self.cell_mm3
        if differs > limit:
            return f"{differs:.4g} mm³ of it are not where the model is"
        layers = float(np.abs(np.rint(w) - (w > 0.5)).sum()) * self.cell_mm3
        if layers > limit:
            return f"{layers:.4g} mm³ of it overlap or are inside out"
        volume = float(manifold.volume())
        allowed = limit + self.undecided_mm3 + _SIGMAS * self.sigma_mm3
        if abs(volume - self.volume_mm3) > allowed:
            return f"its volume is {volume:.4g} mm³, the model encloses {self.volume_mm3:.4g} mm³"
        return None


def _jittered(vertices: Float) -> tuple[Float, float]:
    """One random point per cell of a grid over the bounds: (n, 3), and the volume of a cell.

    Cells are about cubic, at least four along the shortest side, always from the same seed.
    """
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    extents = np.maximum(high - low, 1e-300)
    edge = float(np.prod(extents) / _SAMPLES) ** (1 / 3)
    counts = np.clip(np.rint(extents / edge), 4, 4096).astype(np.int64)
    index = np.stack(np.meshgrid(*(np.arange(n) for n in counts), indexing="ij"), axis=-1)
    offsets = np.random.default_rng(_SEED).random((int(counts.prod()), 3))
    points = low + (index.reshape(-1, 3) + offsets) / counts * extents
    return points, float(np.prod(extents / counts))
