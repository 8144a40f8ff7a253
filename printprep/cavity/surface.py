"""The cavity's surface: the level set of depth at the wall thickness, within a stated tolerance.

Marching cubes draws chords of the true offset surface.  Where the outside has a reentrant edge the
offset surface bulges toward it, and a chord lies closer than the wall.  There the field is convex,
and lowered by as much as a chord is off.  Where some of the wall is still missing, corners of the
surface move; where that does not help, at the necks of a cavity, the field is lowered and the
surface drawn again.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.cavity.fewer_triangles import (
    CORRECTED_MM,
    LOST_MM,
    measured,
    with_fewer_triangles,
)
from printprep.grid.distance import DepthField
from printprep.mesh.aabb_tree import tree_of
from printprep.mesh.gap import gap_mm
from printprep.mesh.measure import arrays
from printprep.mesh.quantize import quantized_arrays

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float

# On the mean a chord of a cell lies so much of a second difference outside the level set: an eighth
# for the place of its ends, on edges of the cell, and up to a quarter for its middle, along a
# diagonal.  What is left is corrected.
CHORD = 0.2
MOST_DRAWINGS = 8
# No wall is thinner than asked by more, with room for the rounding of written coordinates.
PROMISED_MM = 0.045
# Flat regions may move this much when triangles are merged.
FLAT_MM = 0.01
# Shares of the triangles that are tried, the fewest first.
SHARES = (1 / 8, 1 / 4, 1 / 2, 1.0)
# Most of the material around the cavity that fewer triangles may add: half a percent.
LOST_SHARE = 0.005


def cavity_surface(solid: Manifold, field: DepthField | None, wall_mm: float) -> Manifold:
    """The hollowable volume: all of a solid that lies deeper than ``wall_mm``.

    Parameters
    ----------
    solid : the solid to hollow;  field : its depth, exact near the wall's depth; None where nothing
    is that deep.

    Returns
    -------
    Manifold with few triangles, nowhere closer to the solid's surface than the wall less 0.045 mm.

    Raises
    ------
    ArithmeticError : the correction does not converge (a defect here, not of the input).
    """
    if field is None:
        from manifold3d import Manifold

        return Manifold()
    outside = tree_of(*quantized_arrays(solid))
    field = DepthField(field.grid, field.depth_mm.copy())
    lower_convex(field, wall_mm)
    shares = list(SHARES)
    for drawing in range(MOST_DRAWINGS):
        drawn = isosurface(field, wall_mm)
        if drawn.is_empty():
            return drawn
        vertices, faces = arrays(drawn.simplify(FLAT_MM))
        if field.grid.pitch_mm > wall_mm and drawing < MOST_DRAWINGS - 1:
            # Such cells are far off where the outside has details: no try would succeed
            walls = measured(vertices, faces, outside, wall_mm)
            if walls.worst_mm > LOST_MM:
                thin = walls.missing_mm > CORRECTED_MM
                _lower(field, walls.at_mm[thin], walls.missing_mm[thin])
                continue
        least_mm3 = float(drawn.volume() - LOST_SHARE * (solid.volume() - drawn.volume()))
        while True:
            share = shares[0]
            fewer = with_fewer_triangles(
                vertices, faces, share, outside, wall_mm, least_mm3 if share < 1 else 0.0
            )
            found = fewer.solid
            if found is not None and (share == 1 or _wall_holds(solid, found, wall_mm)):
                return found
            if share == 1 or (len(fewer.necks_mm) and drawing % 2 == 0):
                break
            del shares[0]
        _lower(field, fewer.necks_mm, fewer.missing_mm)
    raise ArithmeticError(f"Walls of {wall_mm} mm are not reached in {MOST_DRAWINGS} drawings.")


def _wall_holds(solid: Manifold, cavity: Manifold, wall_mm: float) -> bool:
    """Whether the wall is as thick as promised between samples too, by the exact distance."""
    least_mm = wall_mm - PROMISED_MM
    return gap_mm(solid, cavity, least_mm) >= least_mm


def lower_convex(field: DepthField, level_mm: float) -> None:
    """Lower a field near a level by what chords of it are off where it is convex, in place."""
    depth, pitch = field.depth_mm, np.float32(field.grid.pitch_mm)
    inner = depth[1:-1, 1:-1, 1:-1]
    near = np.flatnonzero(np.abs(inner - np.float32(level_mm)) < 2 * pitch)
    at = np.unravel_index(near, inner.shape)
    middle = inner[at]
    sag = np.zeros(len(near), dtype=np.float32)
    for axis in range(3):
        below, above = ([index + 1 for index in at] for _ in range(2))
        below[axis], above[axis] = at[axis], at[axis] + 2
        sag += np.maximum(depth[tuple(below)] + depth[tuple(above)] - 2 * middle, 0)
    inner[at] = middle - np.float32(CHORD) * sag


def isosurface(field: DepthField, level_mm: float) -> Manifold:
    """The region of a field above a level, as a manifold (marching cubes, Lewiner et al. 2003)."""
    from manifold3d import Error, Manifold, Mesh64
    from skimage.measure import marching_cubes

    pitch = field.grid.pitch_mm
    padded = np.pad(field.depth_mm, 1, constant_values=np.float32(level_mm - 2 * pitch))
    # A value equal to the level makes triangles without area; a value just below it does not.
    padded[padded == np.float32(level_mm)] -= np.float32(1e-4 * pitch)
    if not (padded > level_mm).any():
        return Manifold()
    vertices, faces, _, _ = marching_cubes(padded, level_mm)
    points = field.grid.origin_mm + pitch * (vertices.astype(np.float64) - 1)
    # skimage orients faces by the gradient's descent: with depth, outward needs the reverse.
    manifold = Manifold(Mesh64(points, np.ascontiguousarray(faces[:, ::-1]).astype(np.uint64)))
    if manifold.status() != Error.NoError or manifold.volume() <= 0:
        raise ArithmeticError(f"The isosurface is not a solid: {manifold.status().name}.")
    return manifold


def _lower(field: DepthField, places: Float, missing: Float) -> None:
    """Lower the eight values around each place by what is missing there.

    The field changes in place.  places : (n, 3) mm;  missing : (n,) mm.
    """
    corner = np.floor((places - field.grid.origin_mm) / field.grid.pitch_mm).astype(int)
    amount = np.zeros(field.depth_mm.shape, dtype=np.float32)
    last = np.array(field.depth_mm.shape) - 1
    for step in np.ndindex(2, 2, 2):
        index = np.clip(corner + step, 0, last)
        np.maximum.at(amount, tuple(index.T), missing.astype(np.float32))
    field.depth_mm[...] -= amount
