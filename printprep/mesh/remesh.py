"""The last repair rung: a new surface around the space that is inside by winding number.

Notation: d the exact distance to the model's triangles, w the generalized winding number.  The
field is f = d · clamp(4(w − ½), −1, 1), and the new surface is f = 0.  Where the model is closed, w
is within ¼ of 0 or 1, f is the signed distance and the surface is the model's.  Where it is open, w
runs smoothly from 0 to 1 across the gap and closes it along w = ½.  f is continuous: w jumps only
on the triangles, where d = 0.

Marching cubes: Lorensen and Cline 1987, in the topologically consistent cases of Lewiner 2003.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import (
    distance_to_mesh_mm,
    signed_volumes,
    together,
    try_manifold,
)
from printprep.mesh.shells import Candidate, Refusal
from printprep.mesh.winding_columns import winding_in_columns
from printprep.wording import counted

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

CELLS = 200  # along the longest side
_BLOCK = 4  # cells along an edge of the coarse blocks that decide where to look closely
_MARGIN = 2 * _BLOCK  # cells around the model
# The grid is shifted by fractions of a cell, so that no node falls on a model's own coordinates.
_ASIDE = np.array((0.3183, 0.3679, 0.4142))
_LEAST = 1e-3  # |f| stays above this share of a cell, else triangles degenerate at grid points
_SIMPLIFY = 0.05  # cells that the surface may move when triangles are merged
_CRUMB_CELLS = 8  # a shell of fewer cells is noise of the winding number around open edges
_CORNERS_LOST = 0.1  # mean depth, in cells, that marching cubes cuts off at edges


def remeshed(vertices: Float, faces: Int) -> Candidate | Refusal:
    """The solid {w > ½} of a mesh by marching cubes; vertices : (n, 3) mm, faces : (m, 3)."""
    from skimage.measure import marching_cubes

    low, high = vertices.min(axis=0), vertices.max(axis=0)
    pitch = float((high - low).max()) / CELLS
    origin = low - (_MARGIN + _ASIDE) * pitch
    field = _field(vertices, faces, origin, high - low, pitch)
    if not (field > 0).any():
        return Refusal("no node of the new grid lies inside it")
    corners, triangles, _, _ = marching_cubes(field, 0.0, allow_degenerate=False)
    points = corners.astype(np.float64) * pitch + origin
    triangles = triangles.astype(np.int64)
    if signed_volumes((points - points.mean(axis=0))[triangles]).sum() < 0:
        triangles = triangles[:, ::-1]
    manifold, status = try_manifold(points, triangles)
    if status != "NoError":
        return Refusal(f"the new surface is not a manifold ({status})")
    manifold, crumbs = _without_crumbs(manifold.simplify(_SIMPLIFY * pitch), pitch)
    if manifold.is_empty():
        return Refusal("all of it is thinner than a cell of the new grid")
    actions = [f"Made a new surface by winding number, in cells of {pitch:.3g} mm."]
    if crumbs:
        actions.append(f"Left out {counted(crumbs, 'crumb')} at open edges.")
    return Candidate(
        manifold,
        tuple(actions),
        resolution_mm=pitch,
        slack_mm3=_CORNERS_LOST * pitch * float(manifold.surface_area()),
    )


def _without_crumbs(manifold: Manifold, pitch: float) -> tuple[Manifold, int]:
    """The manifold without shells of a few cells, and how many those are."""
    parts = manifold.decompose()
    kept = [part for part in parts if abs(part.volume()) >= _CRUMB_CELLS * pitch**3]
    if len(kept) == len(parts):
        return manifold, 0
    return (together(kept) if kept else type(manifold)()), len(parts) - len(kept)


def _field(vertices: Float, faces: Int, origin: Float, extents: Float, pitch: float) -> Float:
    """(nx, ny, nz) f at the nodes of the grid; far from the surface only the sign is right.

    vertices : (n, 3) mm;  faces : (m, 3);  origin, extents : (3,) mm;  pitch : mm.
    """
    blocks = np.ceil((extents / pitch + 2 * _MARGIN) / _BLOCK).astype(np.int64)
    everywhere = np.ones(blocks + 1, dtype=bool)
    coarse = _BLOCK * pitch
    w = _winding(everywhere, vertices, faces, origin, coarse).reshape(blocks + 1)
    d = distance_to_mesh_mm(_nodes(everywhere, origin, coarse), vertices, faces)
    close = _close_blocks(w, d.reshape(blocks + 1), pitch)
    # A node far from the surface has the sign of its block, the same at all corners of the block.
    f = np.where(_spread(w[:-1, :-1, :-1] > 0.5), pitch, -pitch).astype(np.float64)
    near = _spread(close)
    w_near = _winding(near, vertices, faces, origin, pitch)
    f[near] = np.where(w_near > 0.5, pitch, -pitch)
    # Marching cubes reads values only at the two ends of a crossed edge.
    crossed = _crossed(f > 0) & near
    decided = w_near[crossed[near]]
    distance = distance_to_mesh_mm(_nodes(crossed, origin, pitch), vertices, faces)
    value = distance * np.clip(4 * (decided - 0.5), -1, 1)
    least = _LEAST * pitch
    f[crossed] = np.where(decided > 0.5, np.maximum(value, least), np.minimum(value, -least))
    return f


def _winding(wanted: Bool, vertices: Float, faces: Int, origin: Float, pitch: float) -> Float:
    """(k,) winding numbers at the True nodes of ``wanted`` (nx, ny, nz), in C order."""
    flat = wanted.reshape(-1, wanted.shape[2])
    used, inverse = np.unique(np.nonzero(flat)[0], return_inverse=True)
    xy = np.stack(np.unravel_index(used, wanted.shape[:2]), axis=-1)
    z = origin[2] + pitch * np.nonzero(flat)[1]
    return winding_in_columns(vertices, faces, origin[:2] + pitch * xy, inverse, z)


def _close_blocks(w: Float, d: Float, pitch: float) -> Bool:
    """(bx, by, bz) blocks that the surface may cross: near triangles, or w not clearly 0 or 1.

    w, d : (bx + 1, by + 1, bz + 1) winding numbers, and distances in mm, at the corners of blocks.
    """
    reach = np.sqrt(3) / 2 * _BLOCK * pitch  # from anywhere in a block to its nearest corner
    slices = (slice(None, -1), slice(1, None))
    corners = [(i, j, k) for i in slices for j in slices for k in slices]
    nearest = np.minimum.reduce([d[corner] for corner in corners])
    lowest = np.minimum.reduce([w[corner] for corner in corners])
    highest = np.maximum.reduce([w[corner] for corner in corners])
    result: Bool = (nearest <= reach) | ((lowest < 0.6) & (highest > 0.4))
    return result


def _spread(blocks: Bool) -> Bool:
    """(nx, ny, nz) values of blocks (bx, by, bz) at the nodes of their cells.

    A node between blocks is True where one of them is.
    """
    fine: Bool = blocks
    for axis in range(3):
        fine = np.repeat(fine, _BLOCK, axis=axis)
        fine = np.concatenate([fine, np.take(fine, [-1], axis=axis)], axis=axis)
        earlier = np.take(fine, np.maximum(np.arange(fine.shape[axis]) - 1, 0), axis=axis)
        fine = np.maximum(fine, earlier)
    return fine


def _nodes(wanted: Bool, origin: Float, pitch: float) -> Float:
    """(k, 3) mm, positions of the True nodes of ``wanted`` (nx, ny, nz), in C order."""
    return origin + pitch * np.argwhere(wanted)


def _crossed(inside: Bool) -> Bool:
    """(nx, ny, nz) nodes with a neighbour, along a grid edge, on the other side of the surface."""
    result = np.zeros_like(inside)
    for axis in range(3):
        a = [slice(None)] * 3
        b = [slice(None)] * 3
        a[axis], b[axis] = slice(None, -1), slice(1, None)
        differs = inside[tuple(a)] != inside[tuple(b)]
        result[tuple(a)] |= differs
        result[tuple(b)] |= differs
    return result
