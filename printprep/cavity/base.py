"""New material around the feet, as clean extrusions: a seat, and a footprint grown outward.

Feet are never level, and a rounded foot touches the bed in a point.  A seat carries all material
within a millimetre of the bed straight down to it, layer by layer as it will be printed; growth
widens that footprint into a low plinth.  (The paper's base B plays the same part in voxels.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import shells
from printprep.types import Base

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold

# A column exactly as wide as the foot above it would only touch it: coincident walls, which a
# slicer's welding turns into non-manifold edges.  This much more makes the union a true overlap.
OVERLAP_MM = 0.02
# Detail below this in a footprint's outline is below what a nozzle or a laser can follow.
OUTLINE_MM = 0.01
# Columns that add less than this are no base at all.
LEAST_BASE_MM3 = 0.5
ARC_SEGMENTS = 64


@dataclass(frozen=True, eq=False)
class Feet:
    """What of a solid lies within the seat height of the bed.

    slab : the solid between z = 0 and the seat;  columns : that carried down to the bed, outside
    the voids the solid already has;  footprint : outline of the columns on the bed.
    """

    slab: Manifold
    columns: Manifold
    footprint: CrossSection
    voids: Manifold
    seat_mm: float


def feet_of(solid: Manifold, seat_mm: float, first_layer_mm: float, layer_mm: float) -> Feet:
    """Find the feet of a solid and carry them down.

    Layer i is filled wherever the solid has material between the layer's top and the seat, so
    that a foot which narrows upward gains nothing, and a rounded one stands on its full width.
    """
    from manifold3d import CrossSection, Manifold, OpType

    slab = solid.trim_by_plane((0, 0, -1), -seat_mm)
    tops = np.append(np.arange(first_layer_mm, seat_mm - layer_mm / 2, layer_mm), seat_mm)
    columns = []
    footprint = CrossSection()
    for top in tops[::-1]:
        above = slab.trim_by_plane((0, 0, 1), float(top)) if top < seat_mm else None
        outline = solid.slice(float(top)) if above is None else _shadow(above)
        footprint = (footprint + outline).simplify(OUTLINE_MM)
        if not footprint.is_empty():
            columns.append(_offset(footprint, OVERLAP_MM).extrude(float(top)))
    voids = Manifold.batch_boolean(list(shells(solid)[1]), OpType.Add)
    joined = Manifold.batch_boolean(columns, OpType.Add) - voids
    return Feet(slab, joined, footprint, voids, seat_mm)


def base_of(feet: Feet, growth_mm: float) -> Base | None:
    """The base with the footprint grown by ``growth_mm``; None when it would add nothing."""
    plinth = feet.columns
    if growth_mm > 0:
        grown = _offset(feet.footprint, growth_mm)
        plinth = plinth + (grown.extrude(feet.seat_mm) - feet.voids)
    if plinth.is_empty() or (plinth - feet.slab).volume() < LEAST_BASE_MM3:
        return None
    return Base(plinth, feet.seat_mm, growth_mm)


def _offset(outline: CrossSection, distance_mm: float) -> CrossSection:
    from manifold3d import JoinType

    return outline.offset(distance_mm, JoinType.Round, 2.0, ARC_SEGMENTS)


def _shadow(manifold: Manifold) -> CrossSection:
    """The outline of a solid seen from above, as a regular cross-section."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(manifold.project().to_polygons(), FillRule.Positive)
