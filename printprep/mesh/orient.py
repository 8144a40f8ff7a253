"""Turns faces so that neighbours agree, and shells so that their outside faces outward.

Only the order of corners changes: no vertex moves, and no face is added or removed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals, signed_volumes, winding
from printprep.mesh.weld import components, directed_edges, is_closed
from printprep.wording import counted

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


# |V| / A^1.5 is 0.094 for a sphere.  An open piece below this value is a sheet: it has no inside.
_SHEET = 0.01
_WITNESSES = 64  # vertices of a piece that decide inside which others it lies


@dataclass(frozen=True, eq=False)
class _Piece:
    """A piece of surface connected by edges.

    faces : (m, 3);  low, high : (3,) mm, its bounding box;  witnesses : (k, 3) mm, some vertices;
    volume : mm³, about its own centre;  sheet : it has no inside.
    """

    faces: Int
    low: Float
    high: Float
    witnesses: Float
    volume: float
    sheet: bool


def right_side_out(vertices: Float, faces: Int) -> tuple[Int, tuple[str, ...]]:
    """Faces (m, 3) turned so that each shell bounds material, and sentences on what was turned.

    vertices : (n, 3) mm.  Within a piece the orientation of the larger area wins.  A shell that is
    inside out (negative volume) is a void where the smallest shell around it bounds material; it is
    turned where no shell is around it or it lies in a void.  A model whose outermost shells are all
    inside out is turned as a whole, so that its voids stay voids.
    """
    alike, turned = _turned_alike(vertices, faces)
    actions = []
    if turned:
        actions.append(f"Turned {counted(turned, 'face')} to agree with the neighbouring faces.")
    groups = components(alike, len(vertices))
    pieces = [_piece(vertices, alike[group]) for group in groups]
    around = _around(pieces, vertices)
    outermost = [p for p, outer in zip(pieces, around, strict=True) if not outer and not p.sheet]
    sign = -1 if outermost and all(piece.volume < 0 for piece in outermost) else 1
    if sign < 0:
        alike = alike[:, ::-1]
        actions.append("Turned the model right side out.")
    flipped = _misplaced(pieces, around, sign)
    for index in flipped:
        alike[groups[index]] = alike[groups[index]][:, ::-1]
    if flipped:
        actions.append(f"Turned {counted(len(flipped), 'shell')} right side out.")
    return np.ascontiguousarray(alike), tuple(actions)


def _misplaced(pieces: list[_Piece], around: list[list[int]], sign: int) -> list[int]:
    """Indices of the pieces that are inside out where no void can be.

    around : for each piece, those it lies in;  sign : −1 where the whole model is inside out.
    """
    signs = {}
    flipped = []
    for index in sorted(range(len(pieces)), key=lambda i: (-abs(pieces[i].volume), i)):
        piece = pieces[index]
        signs[index] = 1 if sign * piece.volume >= 0 else -1
        if piece.sheet or signs[index] > 0:
            continue
        owner = min(around[index], key=lambda i: (abs(pieces[i].volume), i), default=None)
        if owner is None or signs.get(owner, 1) < 0:
            signs[index] = 1
            flipped.append(index)
    return sorted(flipped)


def _turned_alike(vertices: Float, faces: Int) -> tuple[Int, int]:
    """Faces (m, 3) that agree across every edge with exactly two, and how many were turned."""
    if is_closed(faces, once=True):
        return faces.copy(), 0
    edges = directed_edges(faces)
    size = int(faces.max(initial=0)) + 1
    low, high = edges.min(axis=1), edges.max(axis=1)
    _, index, count = np.unique(low * size + high, return_inverse=True, return_counts=True)
    forward = np.bincount(index.ravel(), weights=edges[:, 0] < edges[:, 1])
    if not ((count == 2) & (forward != 1)).any():
        return faces.copy(), 0
    import igl

    turned, patch = igl.bfs_orient(faces)
    # bfs_orient starts each patch from an arbitrary face: keep the orientation of the larger area.
    changed = (turned != faces).any(axis=1)
    area = np.linalg.norm(area_normals(vertices[faces]), axis=1)
    against = np.bincount(patch, weights=area * changed) > np.bincount(patch, weights=area) / 2
    result = np.where(against[patch][:, None], turned[:, ::-1], turned)
    # Turning a face twice may leave it with another first corner: such faces stay as they were.
    same = changed == against[patch]
    result = np.where(same[:, None], faces, result)
    return np.ascontiguousarray(result, dtype=np.int64), int((~same).sum())


def _piece(vertices: Float, faces: Int) -> _Piece:
    """The piece with faces (m, 3) of the whole mesh's vertices (n, 3) mm."""
    among = np.zeros(len(vertices), dtype=bool)
    among[faces] = True
    used = vertices[among]
    corners = (vertices - used.mean(axis=0))[faces]
    area = float(np.linalg.norm(area_normals(corners), axis=1).sum()) / 2
    volume = float(signed_volumes(corners).sum())
    return _Piece(
        faces=faces,
        low=used.min(axis=0),
        high=used.max(axis=0),
        witnesses=used[:: max(1, len(used) // _WITNESSES)],
        volume=volume,
        sheet=abs(volume) <= _SHEET * area**1.5 and not is_closed(faces, once=False),
    )


def _around(pieces: list[_Piece], vertices: Float) -> list[list[int]]:
    """For each piece, the indices of the larger ones that contain most of its vertices.

    vertices : (n, 3) mm, of the whole mesh.
    """
    solid = [index for index, piece in enumerate(pieces) if not piece.sheet]
    low = np.array([pieces[index].low for index in solid]).reshape(-1, 3)
    high = np.array([pieces[index].high for index in solid]).reshape(-1, 3)
    volume = np.array([abs(pieces[index].volume) for index in solid])
    found: list[list[int]] = []
    for piece in pieces:
        boxed = (low <= piece.low).all(axis=1) & (high >= piece.high).all(axis=1)
        candidates = np.flatnonzero(boxed & (volume > abs(piece.volume)))
        found.append([])
        for index in (solid[k] for k in candidates.tolist()):
            inside = np.abs(winding(piece.witnesses, vertices, pieces[index].faces)) > 0.5
            if 2 * int(inside.sum()) > len(inside):
                found[-1].append(index)
    return found
