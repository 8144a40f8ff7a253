"""Contracting edges too short to mean anything.

Booleans leave them where faces nearly coincide, with strips of triangles thinner than any program
resolves.  A slicer that meets one may stumble: PrusaSlicer put 0.1 g of support under a step of
0.0008 mm in a layer's outline.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, from_arrays
from printprep.mesh.weld import directed_edges

if TYPE_CHECKING:
    from manifold3d import Manifold


def contract_short_edges(manifold: Manifold, length_mm: float) -> Manifold:
    """The manifold with its edges shorter than a length contracted, and what is then flat left out.

    Corners that such edges join, directly or by way of others, move to one of them: mostly by less
    than twice the length.  Then the surface is simplified, by half of it.

    Raises GeometryError where that leaves no solid.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    vertices, faces = arrays(manifold)
    start, end = directed_edges(faces).T
    once = start < end  # the surface is closed: each edge is there both ways
    start, end = start[once], end[once]
    short = ((vertices[start] - vertices[end]) ** 2).sum(axis=1) < length_mm**2
    if not short.any():
        return manifold
    size = len(vertices)
    links = coo_matrix((np.ones(int(short.sum())), (start[short], end[short])), shape=(size, size))
    label = connected_components(links, directed=False)[1]
    first = np.unique(label, return_index=True)[1]
    # Corners in one place stay two in the kernel, until it collapses the edge between them.
    return from_arrays(vertices[first[label]], faces).simplify(length_mm / 2)
