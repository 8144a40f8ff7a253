"""The support blocker: the solid in which a slicer makes no supports.

Notation: d depth below the model's surface, w wall, h the largest height between two layers.

A slicer puts support under material that has none of the layer below within reach.  Such material
lies at most h over air.  Over the air outside it has d ≤ h.  Over a cavity, which begins at d = w,
it has d ≥ w − h.  So every solid between the levels d = h and d = w − h covers all ceilings of all
cavities, and no overhang outside.  The blocker lies halfway, at d = w / 2, which leaves the most
room for simplification.  The ceilings of drain holes and of the model's own openings stay outside
it: they are surfaces too.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.surface import isosurface, lower_convex
from printprep.errors import GeometryError
from printprep.grid.distance import DepthField, Surface
from printprep.mesh.measure import arrays
from printprep.mesh.quantize import quantized, quantized_arrays
from printprep.mesh.weld import directed_edges, opposite_edges

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.profiles import Profile

# Room between the blocker's surface and each of its limits: slices are closed, corners rounded.
MARGIN_MM = 0.02
# The surface is simplified by this share of the room on either side; the first that keeps the
# limits is taken.
_COARSENESS = (0.5, 0.4, 0.3, 0.2, 0.1, 0.05)
# What may be left uncovered: less than the rounding of coordinates makes.
_CRUMB_MM3 = 1e-3


def tallest_step_mm(profile: Profile) -> float:
    """Largest height between the middles of two layers."""
    layer_mm, first_mm = profile.printer.layer_height_mm, profile.printer.first_layer_mm
    return float(max(layer_mm, (layer_mm + first_mm) / 2))


def support_blocker(
    solid: Manifold, field: DepthField, hollowable_volume: Manifold, profile: Profile
) -> Manifold | None:
    """The blocker for cavities in a hollowable volume; None where walls are too thin for one.

    Parameters
    ----------
    solid : the model's solid, in printing position.
    field : its depth, exact around the depth of the wall.
    hollowable_volume : all that may be cavity, before vaults are taken out of it.
    """
    step_mm = tallest_step_mm(profile)
    level_mm, least_mm = profile.wall_mm / 2, step_mm + MARGIN_MM
    if level_mm <= least_mm:
        return None
    outside = Surface.of(solid)
    raised = hollowable_volume.translate((0.0, 0.0, step_mm))
    drawn = isosurface(_around_cavities(field, profile.wall_mm, level_mm), level_mm)
    for share in _COARSENESS:
        try:
            blocker = quantized(drawn.simplify(share * (level_mm - least_mm)))
        except GeometryError:  # it touches itself; a finer one may not
            continue
        covers = (raised - blocker).volume() < _CRUMB_MM3
        if covers and _least_depth(blocker, outside)[0] >= least_mm:
            return blocker
    return None


def without_bores(blocker: Manifold, bores: Manifold, profile: Profile) -> Manifold:
    """The blocker without what would cover the ceilings of drain holes."""
    if bores.is_empty():
        return blocker
    step_mm = tallest_step_mm(profile) + MARGIN_MM
    return blocker - bores - bores.translate((0.0, 0.0, step_mm))


def _around_cavities(field: DepthField, wall_mm: float, level_mm: float) -> DepthField:
    """A field above a level only within a wall of a cavity."""
    from scipy.ndimage import maximum_filter

    pitch_mm, depth = field.grid.pitch_mm, field.depth_mm
    reach = 2 * int(np.ceil(wall_mm / pitch_mm)) + 1
    near = maximum_filter(depth, size=reach) > wall_mm
    kept = np.where(near, depth, np.minimum(depth, np.float32(level_mm - pitch_mm / 2)))
    around = DepthField(field.grid, kept)
    lower_convex(around, level_mm)
    return around


def depth_mm(blocker: Manifold, outside: Manifold) -> tuple[float, tuple[float, float, float]]:
    """Least depth of a blocker's surface below the outside of a part, and where (x, y, z)."""
    least_mm, at = _least_depth(blocker, Surface(*quantized_arrays(outside)))
    x, y, z = at.tolist()
    return least_mm, (x, y, z)


def _least_depth(blocker: Manifold, outside: Surface) -> tuple[float, Float]:
    """Least depth, over corners and middles of edges and facets; and (3,) mm, where."""
    vertices, faces = arrays(blocker)
    first, _ = opposite_edges(faces)
    edges = vertices[directed_edges(faces)[first]].mean(axis=1)
    points = np.concatenate([vertices, vertices[faces].mean(axis=1), edges])
    depth = outside.depth_mm(points)
    least = int(np.argmin(depth))
    return float(depth[least]), points[least]
