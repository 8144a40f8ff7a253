"""Sews cracks: joins corners at open edges that lie almost on each other, where that closes all.

Programs that round coordinates, or that write each face by itself, leave cracks of some hundredths
of a millimetre: a surface that looks whole is open, up to every triangle on its own.  Only corners
of open edges move, by no more than what a print does not show.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.weld import compact, distinct, first_near, is_closed, unmatched_edges

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.types import Model

# Widths of cracks that are sewn, the narrowest first; a nozzle or a pixel is no finer than 0.05 mm.
_CRACKS_MM = (0.001, 0.005, 0.02, 0.05)
# Nor is a crack wider than this share of the model's longest side.
_SHARE = 2e-3


@dataclass(frozen=True, eq=False)
class Seams:
    """A model with its cracks sewn.

    moved_mm : how far corners moved at most;  actions : a sentence on them, none where there are no
    cracks.
    """

    model: Model
    moved_mm: float = 0.0
    actions: tuple[str, ...] = ()


def sewn(model: Model) -> Seams:
    """The model with its cracks sewn; as it is where that does not close it."""
    vertices, faces = model.vertices, model.faces
    open_edges = unmatched_edges(faces)
    if not len(open_edges):
        return Seams(model)
    most_mm = _SHARE * float(np.ptp(vertices, axis=0).max())
    rims = np.unique(open_edges)
    for crack_mm in _CRACKS_MM:
        if crack_mm > most_mm:
            break
        found = _joined(vertices, faces, rims, crack_mm)
        if found is None:
            continue
        joined, kept, moved_mm = found
        paint = model.paint
        if paint is not None:
            paint = replace(paint, labels=paint.labels[kept])
        corners, triangles = compact(vertices, joined)
        closed = replace(model, vertices=corners, faces=triangles, paint=paint)
        action = f"Sewed cracks of up to {moved_mm:.2g} mm along {len(open_edges)} open edges."
        return Seams(closed, moved_mm, (action,))
    return Seams(model)


def _joined(
    vertices: Float, faces: Int, rims: Int, crack_mm: float
) -> tuple[Int, Int, float] | None:
    """Closed faces (k, 3), which of faces (m, 3) they were, and how far corners moved in mm.

    vertices : (n, 3) mm;  rims : (r,) the corners of open edges.  None where it stays open, or a
    corner would move by more than twice the width of a crack: a row of near corners is an edge, not
    one corner.
    """
    first = np.arange(len(vertices))
    first[rims] = rims[first_near(vertices[rims], crack_mm)]
    moved_mm = float(np.linalg.norm(vertices - vertices[first], axis=1).max())
    kept = np.flatnonzero(distinct(first[faces]))
    joined: Int = first[faces[kept]]
    if not len(kept) or moved_mm > 2 * crack_mm or not is_closed(joined, once=False):
        return None
    return joined, kept, moved_mm
