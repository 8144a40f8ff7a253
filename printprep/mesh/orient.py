"""Which side of each face is outside: faces turned alike, shells turned right side out.

No vertex moves here and no face comes or goes; only the order of corners changes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import signed_volumes, winding
from printprep.mesh.weld import components, directed_edges, edge_counts

if TYPE_CHECKING:
    from printprep.arrays import Float, Int


# |V| / A^1.5 is 0.094 for a sphere.  An open piece below this is a sheet: it has no inside.
_SHEET = 0.01
_WITNESSES = 64


@dataclass(frozen=True, eq=False)
class _Piece:
    """A piece of surface that hangs together by edges; ``volume`` about its own centre, mm³."""

    faces: Int
    low: Float
    high: Float
    witnesses: Float
    volume: float
    sheet: bool


def right_side_out(vertices: Float, faces: Int) -> tuple[Int, tuple[str, ...]]:
    """Faces (m, 3) turned so that each shell bounds material, and sentences on what was turned.

    Within a piece the orientation of the larger area wins.  Between pieces a shell that is inside
    out (negative volume) is a void when the smallest shell around it bounds material, and was
    meant the other way round when nothing is around it or it lies in a void already.  A model all
    of whose outermost shells are inside out is turned as a whole, so that its voids stay voids.
    """
    alike, turned = _turned_alike(vertices, faces)
    actions = [f"Turned {turned} faces to agree with their neighbours."] if turned else []
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
        actions.append(f"Turned {_count(len(flipped), 'shell')} right side out.")
    return np.ascontiguousarray(alike), tuple(actions)


def _misplaced(pieces: list[_Piece], around: list[list[int]], sign: int) -> list[int]:
    """Pieces that are inside out where no void can be, given the sign all others are read with."""
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
    """Faces turned to agree across every edge that has just two, and how many were turned."""
    edges = directed_edges(faces)
    _, index, count = np.unique(
        np.sort(edges, axis=1), axis=0, return_inverse=True, return_counts=True
    )
    forward = np.bincount(index.ravel(), weights=edges[:, 0] < edges[:, 1])
    if not ((count == 2) & (forward != 1)).any():
        return faces.copy(), 0
    import igl

    turned, patch = igl.bfs_orient(faces)
    # bfs_orient starts each patch from an arbitrary face: keep the side the larger area was on.
    changed = (turned != faces).any(axis=1)
    corners = vertices[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    against = np.bincount(patch, weights=area * changed) > np.bincount(patch, weights=area) / 2
    result = np.where(against[patch][:, None], turned[:, ::-1], turned)
    # Turning twice reverses the order of corners, which may leave the same face written otherwise.
    same = changed == against[patch]
    result = np.where(same[:, None], faces, result)
    return np.ascontiguousarray(result, dtype=np.int64), int((~same).sum())


def _piece(vertices: Float, faces: Int) -> _Piece:
    used = vertices[np.unique(faces)]
    corners = (vertices - used.mean(axis=0))[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    area = float(np.linalg.norm(normals, axis=1).sum()) / 2
    volume = float(signed_volumes(corners).sum())
    return _Piece(
        faces=faces,
        low=used.min(axis=0),
        high=used.max(axis=0),
        witnesses=used[:: max(1, len(used) // _WITNESSES)],
        volume=volume,
        sheet=abs(volume) <= _SHEET * area**1.5 and edge_counts(faces).open_edges > 0,
    )


def _around(pieces: list[_Piece], vertices: Float) -> list[list[int]]:
    """For each piece, the indices of the larger ones that most of its vertices lie inside of."""
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


def _count(number: int, noun: str) -> str:
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
