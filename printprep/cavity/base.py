"""The base: new material around the feet, as clean extrusions.

Feet are never level, and a rounded foot touches the bed in a point.  A seat carries all material
within a millimetre of the bed straight down to it, layer by layer as it prints.  Growth widens that
footprint into a low plinth.  (The paper's base B does the same in voxels.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import shells
from printprep.types import Base

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold

# A column exactly as wide as the gap under a foot only touches the foot: the walls coincide, and a
# slicer's welding makes non-manifold edges of them.  This much more makes the union a true overlap.
OVERLAP_MM = 0.02
# A section through a flat bottom face is ill-defined; just above it is not.
JUST_ABOVE_MM = 1e-4
# A nozzle or a laser does not follow finer detail than this in a footprint's outline.
OUTLINE_MM = 0.01
# Columns that add less than this do not count as a base.
LEAST_BASE_MM3 = 0.5
ARC_SEGMENTS = 64


@dataclass(frozen=True, eq=False)
class Feet:
    """The part of a solid that lies within the seat height of the bed.

    slab : the solid between z = 0 and the seat;  columns : the slab carried down to the bed,
    outside the voids that the solid already has;  footprint : outline of the columns on the bed;
    voids : those voids, as positive solids.
    """

    slab: Manifold
    columns: Manifold
    footprint: CrossSection
    voids: Manifold
    seat_mm: float


def slab_of(solid: Manifold, seat_mm: float) -> Manifold:
    """What of a solid lies in the height of a base's seat."""
    return solid.trim_by_plane((0, 0, -1), -seat_mm)


def feet_of(solid: Manifold, seat_mm: float, first_layer_mm: float, layer_mm: float) -> Feet:
    """Find the feet of a solid and carry them down to the bed, in steps of its layers.

    The gap of a layer lies in the shadow of the seat's material above it, but outside the section
    at the layer's bottom.  A column fills it from the bed to the layer's top.
    """
    from manifold3d import Manifold, OpType

    slab = slab_of(solid, seat_mm)
    bottoms = np.append(0.0, np.arange(first_layer_mm, seat_mm - layer_mm / 2, layer_mm))
    tops = np.append(bottoms[1:], seat_mm)
    columns = []
    for bottom, top in zip(bottoms, tops, strict=True):
        above = slab.trim_by_plane((0, 0, 1), float(bottom))
        gap = _shadow(above) - slab.slice(float(bottom) + JUST_ABOVE_MM)
        # Opening drops slivers thinner than the overlap, where outline and section almost agree.
        gap = _offset(_offset(gap, -OVERLAP_MM), 2 * OVERLAP_MM)
        if not gap.is_empty():
            columns.append(gap.extrude(min(float(top) + OVERLAP_MM, seat_mm)))
    voids = Manifold.batch_boolean(list(shells(solid)[1]), OpType.Add)
    # Outlines of neighbouring layers nearly coincide: merge those that differ by rounding alone.
    joined = (Manifold.batch_boolean(columns, OpType.Add) - voids).simplify(OUTLINE_MM)
    return Feet(slab, joined, _shadow(slab).simplify(OUTLINE_MM), voids, seat_mm)


def base_of(feet: Feet, growth_mm: float) -> Base | None:
    """Build the base with the footprint grown by ``growth_mm``; None when it adds nothing."""
    plinth = feet.columns
    if growth_mm > 0:
        grown = _offset(feet.footprint, growth_mm)
        plinth = (plinth + (grown.extrude(feet.seat_mm) - feet.voids)).simplify(OUTLINE_MM)
    if plinth.is_empty() or (plinth - feet.slab).volume() < LEAST_BASE_MM3:
        return None
    return Base(plinth, feet.seat_mm, growth_mm)


def _offset(outline: CrossSection, distance_mm: float) -> CrossSection:
    from manifold3d import JoinType

    grown = outline.offset(distance_mm, JoinType.Round, 2.0, ARC_SEGMENTS)
    return grown.simplify(OUTLINE_MM)


def _shadow(manifold: Manifold) -> CrossSection:
    """The outline of a solid seen from above, as a regular cross-section."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(manifold.project().to_polygons(), FillRule.Positive)
