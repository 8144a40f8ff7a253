"""How far printed lines stand out over the lines below, measured on the extrusion in a G-code.

Not printprep's own reader: every extruding move is a line as wide as the slicer says (;WIDTH:), and
a line's axis and both its sides are sampled.  What counts is the distance of a sample, seen from
above, to the nearest line of the layer below, 0 over it.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from gcode_moves import extruding_moves
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Float = NDArray[np.float64]
STEP_MM = 0.1
_NOT_PART = ("Skirt", "Support", "Brim", "Custom", "Wipe")


@dataclass(frozen=True, eq=False)
class Lines:
    """The extruding moves of one layer: start, end (n, 2) mm; width (n,) mm."""

    z_mm: float
    start: Float
    end: Float
    width: Float

    def samples(self) -> tuple[Float, Float, Float]:
        """(m, 2) points on the axes, (m, 2) unit normals, (m,) widths."""
        way = self.end - self.start
        length = np.linalg.norm(way, axis=1)
        count = np.maximum(np.ceil(length / STEP_MM).astype(int), 1) + 1
        owner = np.repeat(np.arange(len(count)), count)
        place = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        share = place / (count - 1)[owner]
        along = way / length[:, None]
        normal = np.column_stack([-along[:, 1], along[:, 0]])[owner]
        return self.start[owner] + share[:, None] * way[owner], normal, self.width[owner]


def layers_of(gcode: Path) -> list[Lines]:
    """The lines of the part, layer by layer."""
    rows: dict[float, list[tuple[float, ...]]] = {}
    for move in extruding_moves(gcode):
        if not move.kind.startswith(_NOT_PART):
            row = (*move.start, *move.end, move.width_mm)
            rows.setdefault(round(move.z_mm, 4), []).append(row)
    return [
        Lines(z, *(np.array(rows[z])[:, columns] for columns in ([0, 1], [2, 3], 4)))
        for z in sorted(rows)
    ]


def standing_out(layers: list[Lines]) -> tuple[Float, Float]:
    """(n, 3) mm, samples of axes and sides of all lines but the first layer's, and (n,) mm, how far
    each lies from the lines below."""
    places, out = [], []
    for below, here in pairwise(layers):
        axis, _, lower_width = below.samples()
        points, normal, width = here.samples()
        sides = [points + side * normal * width[:, None] / 2 for side in (-1, 0, 1)]
        samples = np.concatenate(sides)
        far = np.zeros(len(samples))
        # Lines of one width are one tree: the nearest axis is then the nearest line.
        far[:] = np.inf
        for each in np.unique(lower_width):
            tree = cKDTree(axis[lower_width == each])
            far = np.minimum(far, tree.query(samples)[0] - each / 2)
        places.append(np.column_stack([samples, np.full(len(samples), here.z_mm)]))
        out.append(np.maximum(far, 0.0))
    return np.concatenate(places), np.concatenate(out)
