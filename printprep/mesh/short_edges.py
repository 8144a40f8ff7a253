"""Contracts edges that are too short to carry any shape.

Booleans leave such edges where faces nearly coincide, with strips of triangles thinner than any
program resolves.  They can mislead a slicer: PrusaSlicer put 0.1 g of support under a step of
0.0008 mm in a layer's outline.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.mesh.measure import arrays, from_arrays
from printprep.mesh.weld import directed_edges, first_connected

if TYPE_CHECKING:
    from manifold3d import Manifold


def contract_short_edges(manifold: Manifold, length_mm: float) -> Manifold:
    """The manifold with all edges shorter than a length contracted, then simplified.

    Vertices connected by short edges, directly or through others, move to one of them: mostly by
    less than twice the length.  Then the surface is simplified, by half the length.

    Raises GeometryError where that leaves no solid.
    """
    vertices, faces = arrays(manifold)
    start, end = directed_edges(faces).T
    once = start < end  # the surface is closed: each edge occurs in both directions
    start, end = start[once], end[once]
    short = ((vertices[start] - vertices[end]) ** 2).sum(axis=1) < length_mm**2
    if not short.any():
        return manifold
    first = first_connected(start[short], end[short], len(vertices))
    # Vertices at one position stay two in the kernel, until it collapses the edge between them.
    return from_arrays(vertices[first], faces).simplify(length_mm / 2)
