"""Measures the shells of a surface all at once, and leaves out those too small to print.

The boolean kernel takes a solid apart into manifolds of their own, which takes minutes for the
thousands of crumbs that near-coincident surfaces leave.  Here the shells are labels on the faces:
one pass over the edges, whatever their number.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.kept import kept
from printprep.mesh.measure import arrays, from_arrays, signed_volumes, together
from printprep.mesh.weld import compact, connected, directed_edges, is_closed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

# A shell is a crumb only below this share of all volume: a model that is small as a whole stays.
CRUMB_SHARE = 1e-3


@dataclass(frozen=True, eq=False)
class ShellFigures:
    """The k shells of a closed surface, by the vertices that they share.

    label : (m,) shell of each face;  volume_mm3 : (k,) signed, negative for a void;
    low_mm, high_mm : (k, 3) bounding boxes.
    """

    label: Int
    volume_mm3: Float
    low_mm: Float
    high_mm: Float

    def crumbs(self, least_mm3: float) -> Bool:
        """(k,) which shells enclose less than a volume, and less than a share of the whole."""
        size = np.abs(self.volume_mm3)
        result: Bool = size < min(least_mm3, CRUMB_SHARE * float(size.sum()))
        return result


@kept(most=1)
def shell_figures(vertices: Float, faces: Int) -> ShellFigures:
    """Measure the shells of vertices (n, 3) mm and faces (m, 3)."""
    a, b, c = faces.T
    component = connected(np.append(a, b), np.append(b, c), len(vertices))
    used = np.zeros(int(component.max(initial=-1)) + 1, dtype=bool)
    used[component[a]] = True
    number = np.cumsum(used) - 1
    count, label = int(used.sum()), number[component[a]]
    points, owner = vertices, number[component]
    if not used.all():  # some vertices have no faces
        points, owner = vertices[used[component]], owner[used[component]]
    if count == 1:
        low, high = points.min(axis=0)[None], points.max(axis=0)[None]
    else:
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, owner, points)
        np.maximum.at(high, owner, points)
    corners = vertices[faces]
    # About a point of its own, each shell keeps all the digits of its volume.
    each = signed_volumes(corners - low[label][:, None])
    volume: Float = np.bincount(label, weights=each, minlength=count).astype(np.float64)
    return ShellFigures(label, volume, low, high)


def closed_shells(faces: Int, figures: ShellFigures) -> Bool:
    """(k,) which shells of faces (m, 3) are closed: along each edge as many faces run each way."""
    closed = np.ones(len(figures.volume_mm3), dtype=bool)
    if is_closed(faces, once=False):
        return closed
    edges = directed_edges(faces)
    size = int(faces.max(initial=0)) + 1
    low, high = edges.min(axis=1), edges.max(axis=1)
    _, index = np.unique(low * size + high, return_inverse=True)
    index = np.ravel(index)
    balance = np.bincount(index, weights=np.where(edges[:, 0] < edges[:, 1], 1.0, -1.0))
    open_edge = balance[index] != 0
    closed[np.repeat(figures.label, 3)[open_edge]] = False
    return closed


def without_crumbs(manifold: Manifold, least_mm3: float) -> tuple[Manifold, int]:
    """The manifold without its crumbs, and how many they were; bodies and voids alike.

    least_mm3 : the smallest volume that prints (``Profile.crumb_mm3``).
    """
    vertices, faces = arrays(manifold)
    if not len(faces):
        return manifold, 0
    figures = shell_figures(vertices, faces)
    crumbs = figures.crumbs(least_mm3)
    if not crumbs.any():
        return manifold, 0
    return from_arrays(*compact(vertices, faces[~crumbs[figures.label]])), int(crumbs.sum())


def pieces(manifold: Manifold, least_mm3: float) -> tuple[Manifold, ...]:
    """The pieces of at least a volume, each without what lies loose in its voids.

    Only shells that bound a piece from outside are returned, as solids: a negative shell in a
    cavity is an island of material that nothing holds.
    """
    vertices, faces = arrays(manifold)
    if not len(faces):
        return ()
    figures = shell_figures(vertices, faces)
    kept = np.flatnonzero(figures.volume_mm3 >= max(least_mm3, 0.0))
    if len(kept) == len(figures.volume_mm3) == 1:
        return (manifold,)
    return tuple(
        from_arrays(*compact(vertices, faces[figures.label == number])) for number in kept.tolist()
    )


def joined(solids: Sequence[Manifold]) -> Manifold:
    """Disjoint solids as one manifold, empty for none."""
    from manifold3d import Manifold

    if len(solids) == 1:
        return solids[0]
    return together(solids) if solids else Manifold()
