"""Measures the space that a mesh encloses, however broken: the reference for each repair rung.

The generalized winding number w is sampled at jittered points: vertical lines, one per cell of a
grid over x and y, and on each line one point in each of m equal intervals of height.  {w > ½} is
the solid that the mesh describes.  Where ¼ < w < ¾ the surface is open, and there is more than one
way to close it; elsewhere the mesh is unambiguous, and a repair must agree with it.

Error of the sampled volume, for cells of a × a × b and m b = H: only cells that the surface crosses
count, each with a variance of at most a quarter of its square.  A horizontal area A_z crosses
A_z/a² cells; a vertical one, A_x + A_y by its projections, (A_x + A_y)/(a b), m of which share
their line.  So σ² ≤ ¼ (a²b)² (A_z/a² + m (A_x + A_y)/(a b)) = ¼ a²b² (A_z + m a (A_x + A_y)/b).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals, arrays
from printprep.mesh.winding_columns import winding_in_closed, winding_in_columns

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float, Int


_COLUMNS = 120**2
_HEIGHTS = 8
_SEED = 20130721
_UNDECIDED = (0.25, 0.75)
# Share of the volume by which two descriptions of one solid may differ.  Half a percent is a tenth
# of the variation in a filament printer's flow, and more than any closed test model deviates
# (0.06 %).
_SHARE = 0.005
_SIGMAS = 4.0


@dataclass(frozen=True, eq=False)
class Reference:
    """Sampled winding numbers of a mesh, and the volumes that follow.

    columns : (c, 2) mm;  z_mm : (c, m) heights on each column;  winding : (c, m);
    cell_mm3 : volume of the cell around each point;  volume_mm3 : of {w > ½};
    undecided_mm3 : of {¼ < w < ¾};  sigma_mm3 : upper bound of the standard deviation of
    ``volume_mm3``.
    """

    columns: Float
    z_mm: Float
    winding: Float
    cell_mm3: float
    volume_mm3: float
    undecided_mm3: float
    sigma_mm3: float

    @staticmethod
    def of(vertices: Float, faces: Int) -> Reference:
        """Sample a mesh: vertices (n, 3) mm, faces (m, 3)."""
        low, extents = vertices.min(axis=0), np.ptp(vertices, axis=0)
        columns, z = _jittered(low, extents)
        cell = float(np.prod(extents)) / z.size
        w = _winding(vertices, faces, columns, z)
        area_x, area_y, area_z = np.abs(area_normals(vertices[faces])).sum(axis=0) / 2
        a2, b = float(np.prod(extents[:2])) / len(columns), float(extents[2]) / _HEIGHTS
        upright = _HEIGHTS * np.sqrt(a2) / b * (area_x + area_y)
        return Reference(
            columns=columns,
            z_mm=z,
            winding=w,
            cell_mm3=cell,
            volume_mm3=float((w > 0.5).sum()) * cell,
            undecided_mm3=float(((w > _UNDECIDED[0]) & (w < _UNDECIDED[1])).sum()) * cell,
            sigma_mm3=0.5 * b * float(np.sqrt(a2 * (area_z + upright))),
        )

    def disagreement(self, manifold: Manifold, slack_mm3: float = 0.0) -> str | None:
        """How a solid differs from the space that the mesh encloses, or None where it agrees.

        slack_mm3 : volume that the method of the rung may lose (0 for exact ones).
        """
        w = _winding(*arrays(manifold), self.columns, self.z_mm, closed=True)
        limit = _SHARE * self.volume_mm3 + slack_mm3
        decided = (self.winding <= _UNDECIDED[0]) | (self.winding >= _UNDECIDED[1])
        differs = float((decided & ((w > 0.5) != (self.winding > 0.5))).sum()) * self.cell_mm3
        if differs > limit:
            return f"it differs from the model in {differs:.4g} mm³"
        layers = float(np.abs(np.rint(w) - (w > 0.5)).sum()) * self.cell_mm3
        if layers > limit:
            return f"{layers:.4g} mm³ of it overlap or are inside out"
        volume = float(manifold.volume())
        allowed = limit + self.undecided_mm3 + _SIGMAS * self.sigma_mm3
        if abs(volume - self.volume_mm3) > allowed:
            return f"its volume is {volume:.4g} mm³, the model encloses {self.volume_mm3:.4g} mm³"
        return None


def _winding(
    vertices: Float, faces: Int, columns: Float, z: Float, *, closed: bool = False
) -> Float:
    """(c, m) winding numbers at heights z (c, m) on columns (c, 2)."""
    column_of = np.repeat(np.arange(len(columns)), z.shape[1])
    method = winding_in_closed if closed else winding_in_columns
    return method(vertices, faces, columns, column_of, z.ravel()).reshape(z.shape)


def _jittered(low: Float, extents: Float) -> tuple[Float, Float]:
    """Lines (c, 2) through nearly square cells over the bounds, and heights (c, m) on each.

    low, extents : (3,) mm.  The shorter side has four cells or more; the seed is fixed.
    """
    rng = np.random.default_rng(_SEED)
    edge = float(np.sqrt(np.prod(extents[:2]) / _COLUMNS))
    nx, ny = (int(n) for n in np.clip(np.rint(extents[:2] / edge), 4, 4096))
    index = np.stack(np.meshgrid(np.arange(nx), np.arange(ny), indexing="ij"), axis=-1)
    cells = index.reshape(-1, 2) + rng.random((nx * ny, 2))
    heights = np.arange(_HEIGHTS) + rng.random((nx * ny, _HEIGHTS))
    columns: Float = low[:2] + cells / (nx, ny) * extents[:2]
    z: Float = low[2] + heights / _HEIGHTS * extents[2]
    return columns, z
