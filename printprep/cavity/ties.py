"""Ties islands of material in a hollowable volume to its floor.

Where a model has a void that stays, the wall around it floats in the hollowable volume.  Nothing
would hold it when it prints.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, from_arrays
from printprep.mesh.shell_figures import shell_figures
from printprep.mesh.weld import compact

if TYPE_CHECKING:
    from manifold3d import Manifold

# A tie is so much wider than its island on every side.
BESIDE_MM = 0.1
ARC_SEGMENTS = 16
# The outline of a tie may move this much.
OUTLINE_MM = 0.02


def tied(hollowable_volume: Manifold) -> Manifold:
    """The volume without pedestals that reach from its floor up into every island.

    A pedestal has the outline of its island, seen from above, and a little more: nothing overhangs
    beside it, and its sides lie on none of the island's.
    """
    from manifold3d import CrossSection, FillRule, JoinType, Manifold, OpType

    vertices, faces = arrays(hollowable_volume)
    figures = shell_figures(vertices, faces)
    islands = np.flatnonzero(figures.volume_mm3 < 0)
    pedestals = []
    for number in islands.tolist():
        shell = from_arrays(*compact(vertices, faces[figures.label == number][:, ::-1]))
        shadow = CrossSection(shell.project().to_polygons(), FillRule.Positive)
        floor = float(figures.low_mm[figures.volume_mm3 > 0, 2].min()) - 1.0
        middle = float((figures.low_mm[number, 2] + figures.high_mm[number, 2]) / 2)
        outline = shadow.offset(BESIDE_MM, JoinType.Round, 2.0, ARC_SEGMENTS)
        pedestal = outline.simplify(OUTLINE_MM).extrude(middle - floor)
        pedestals.append(pedestal.translate((0.0, 0.0, floor)))
    if not pedestals:
        return hollowable_volume
    return Manifold.batch_boolean([hollowable_volume, *pedestals], OpType.Subtract)
