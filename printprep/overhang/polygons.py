"""Operations on polygons for the overhang rule: growing, closing, windows, and new pieces.

Contours are (k, 2) arrays in mm; outer ones run counter-clockwise, holes clockwise.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import CrossSection

    from printprep.arrays import Float

ARC_SEGMENTS = 16
# Clipping rounds corners; contours whose boxes agree within this are the same contour.
SAME_MM = 1e-3
# Size of the cells that form a window around many boxes.
CELL_MM = 2.0
# Smaller regions come from the rounding of clipping.
LEAST_AREA_MM2 = 1e-4


def grown(region: CrossSection, radius_mm: float) -> CrossSection:
    """The region grown by a disc, or shrunk where the radius is negative."""
    from manifold3d import JoinType

    return region.offset(radius_mm, JoinType.Round, 2.0, ARC_SEGMENTS)


def closed(region: CrossSection, radius_mm: float) -> CrossSection:
    """The region closed by a disc, or opened where the radius is negative."""
    return grown(grown(region, radius_mm), -radius_mm)


def regions(outlines: Sequence[Float]) -> CrossSection:
    """The region that contours (k, 2) enclose, in either direction of running."""
    from manifold3d import CrossSection, FillRule

    return CrossSection(list(outlines), FillRule.NonZero) if outlines else CrossSection()


def windows(outlines: Sequence[Float], margin_mm: float) -> CrossSection:
    """The bounding boxes of contours (k, 2), each widened by a margin, as one region."""
    from manifold3d import CrossSection, OpType

    boxes = []
    for outline in outlines:
        low, high = outline.min(axis=0) - margin_mm, outline.max(axis=0) + margin_mm
        boxes.append(CrossSection.square((high - low).tolist()).translate(low.tolist()))
    return CrossSection.batch_boolean(boxes, OpType.Add)


def cells(low_mm: Float, high_mm: Float) -> CrossSection:
    """The cells of a lattice that boxes meet, as one region; low_mm, high_mm : (n, 2)."""
    from manifold3d import CrossSection, OpType

    first, last = np.floor(low_mm / CELL_MM), np.floor(high_mm / CELL_MM) + 1
    spans = np.unique(np.hstack([first, last]), axis=0) * CELL_MM
    squares = [
        CrossSection.square((span[2:] - span[:2]).tolist()).translate(span[:2].tolist())
        for span in spans
    ]
    return CrossSection.batch_boolean(squares, OpType.Add)


def new_pieces(here: CrossSection, below: CrossSection) -> list[Float]:
    """Contours (k, 2) of material that the void ``here`` encloses and that begins in its layer.

    Such a piece lies entirely over the void ``below``: it is a hole of ``here``, and an outline of
    ``below`` − ``here``, unless that outline has itself a hole where material stands.
    """
    holes, edges = _measured(here, -1)
    if not holes:
        return []
    _, fresh = _measured(below - here, 1)
    if not len(fresh):
        return []
    same = np.abs(edges[:, None] - fresh[None]).max(axis=2) < SAME_MM
    maybe = [hole for hole, found in zip(holes, same.any(axis=1), strict=True) if found]
    return [hole for hole in maybe if (regions([hole]) - below).area() < LEAST_AREA_MM2]


def _measured(region: CrossSection, turn: int) -> tuple[list[Float], Float]:
    """Contours that run one way (+1 counter-clockwise), and (k, 4) boxes: low and high x, y."""
    outlines = region.to_polygons()
    if not outlines:
        return [], np.zeros((0, 4))
    points = np.concatenate(outlines)
    starts = np.cumsum([0, *(len(outline) for outline in outlines[:-1])])
    following = np.arange(1, len(points) + 1)
    following[np.append(starts[1:], len(points)) - 1] = starts
    after = points[following]
    doubled = np.add.reduceat(points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0], starts)
    boxes = np.hstack([np.minimum.reduceat(points, starts), np.maximum.reduceat(points, starts)])
    kept = np.flatnonzero(doubled * turn > 0)
    return [outlines[i] for i in kept], boxes[kept]


def centroid(outlines: Sequence[Float]) -> tuple[float, tuple[float, float]]:
    """Area in mm² and centroid of a region given by its contours (k, 2), holes clockwise."""
    area, moment = 0.0, np.zeros(2)
    for outline in outlines:
        start = outline[0]  # as reference, so that small patches lose no digits
        near = outline - start
        after = np.roll(near, -1, axis=0)
        cross = near[:, 0] * after[:, 1] - near[:, 1] * after[:, 0]
        part = float(cross.sum()) / 2
        area += part
        moment += part * start + (cross[:, None] * (near + after)).sum(axis=0) / 6
    if area <= 0:
        return 0.0, (0.0, 0.0)
    x, y = (moment / area).tolist()
    return area, (x, y)
