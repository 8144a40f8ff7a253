"""The cavity's surface: the level set of depth at the wall thickness, within a stated tolerance.

Marching cubes draws chords of the true offset surface.  Where the outside has a reentrant edge the
offset surface bulges toward it, and a chord lies closer than the wall.  There the field is lowered
by what is missing, and the surface drawn again.  The result is still one clean isosurface.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.grid.distance import DepthField, Surface
from printprep.mesh.measure import arrays
from printprep.mesh.self_intersections import folded

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.arrays import Float

    Float32 = NDArray[np.float32]

# Flat regions may move this much when triangles are merged.
SIMPLIFY_MM = 0.02
# A wall thinner than asked by more than the first is not accepted; then every wall thinner by more
# than the second is corrected.  The promise is 0.05.
ACCEPTED_MM = 0.03
CORRECTED_MM = 0.02
MOST_CORRECTIONS = 8
MOST_HALVINGS = 4


def cavity_surface(solid: Manifold, field: DepthField | None, wall_mm: float) -> Manifold:
    """The hollowable volume: all of a solid that lies deeper than ``wall_mm``.

    Parameters
    ----------
    solid : the solid to hollow;  field : its depth, exact near the wall's depth; None where nothing
    is that deep.

    Returns
    -------
    Manifold, simplified by at most 0.02 mm.  At the samples (facet centres and outside vertices) it
    is nowhere closer to the solid's surface than the wall less 0.03 mm; edges that cross lie up to
    0.01 mm closer.

    Raises
    ------
    ArithmeticError : the correction does not converge (a defect here, not of the input).
    """
    if field is None:
        from manifold3d import Manifold

        return Manifold()
    outside = Surface.of(solid)
    depth = field.depth_mm.copy()
    for round_ in range(MOST_CORRECTIONS):
        # Merging flat triangles spends part of the tolerance: each round spends less of it.
        cavity = _simplified(isosurface(DepthField(field.grid, depth), wall_mm), 2.0**-round_)
        if cavity.is_empty():
            return cavity
        places, missing = _too_thin(outside, Surface.of(cavity), wall_mm)
        if missing.max(initial=0.0) <= ACCEPTED_MM:
            return cavity
        _lower(DepthField(field.grid, depth), places, missing)
    raise ArithmeticError(f"Walls of {wall_mm} mm are not reached in {MOST_CORRECTIONS} rounds.")


def _simplified(cavity: Manifold, share: float) -> Manifold:
    """Simplify by a share of what is allowed, or by less where the surface folds over."""
    for halving in range(MOST_HALVINGS):
        simpler = cavity.simplify(SIMPLIFY_MM * share / 2**halving)
        if simpler.is_empty() or not folded(*arrays(simpler)):
            return simpler
    return cavity


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


def _too_thin(outside: Surface, cavity: Surface, wall_mm: float) -> tuple[Float, Float]:
    """(n, 3) mm, points on the cavity too close to the outside; (n,) mm, what is missing there."""
    import igl

    # Vertices lie on the level set to pitch²/(8·wall), below the tolerance: chords are thin.
    inner = cavity.vertices[cavity.faces].mean(axis=1)
    inner_distance = outside.distance_mm(inner)
    squared, _, nearest = igl.point_mesh_squared_distance(
        outside.vertices, cavity.vertices, cavity.faces
    )
    places = np.vstack([inner, nearest])
    missing = wall_mm - np.concatenate([inner_distance, np.sqrt(squared)])
    thin = missing > CORRECTED_MM
    return places[thin], missing[thin]


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
