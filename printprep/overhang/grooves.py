"""Finds grooves: edges and corners where two walls of a void close too early (suspects.py)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.arrays import runs
from printprep.mesh.weld import directed_edges

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int
    from printprep.overhang.limits import Acceptance
    from printprep.overhang.surface import VoidSurface

# Slopes built to be t count as t up to this difference.  Keels between such walls lean a little
# more, by this factor on a funnel with a polygon as section; only a corner of a few µm reaches out.
_SAME = 1e-6
KEEL = 1.05


def grooves(surface: VoidSurface, rule: Acceptance) -> Int:
    """(k, 2) ends of groove edges; a corner on no such edge stands twice in its own row."""
    closing = _closing_corners(surface, rule)
    edges = directed_edges(surface.faces)
    edges = np.sort(edges[closing[edges].all(axis=1)], axis=1)
    edges = np.unique(edges, axis=0)
    closing[edges] = False
    alone = np.flatnonzero(closing)
    return np.concatenate([edges, np.stack([alone, alone], axis=1)])


def groove_depth_mm(rule: Acceptance) -> float:
    """Height below a groove in which closing fills the void too early: c / t."""
    tan = max(rule.off_mm - rule.closing_mm, 1e-3) / rule.layer_mm
    return rule.closing_mm / tan


def _closing_corners(surface: VoidSurface, rule: Acceptance) -> Bool:
    """(n,) whether two walls meet at a vertex with slopes that are too steep for their angle."""
    tan = (rule.off_mm - rule.closing_mm) / rule.layer_mm
    corner, slope, facing, steep = _walls(surface, tan)
    near = np.zeros(len(surface.vertices), dtype=bool)
    near[corner[steep]] = True
    kept = near[corner]
    corner, slope, facing, steep = corner[kept], slope[kept], facing[kept], steep[kept]
    order = np.argsort(corner, kind="stable")
    corner, slope, facing, steep = corner[order], slope[order], facing[order], steep[order]
    first, last = (np.searchsorted(corner, corner, side) for side in ("left", "right"))
    one, place = runs(last - first)
    other = first[one] + place
    kept = (one != other) & steep[one]
    one, other = one[kept], other[kept]
    apart = 1 - np.einsum("ij,ij->i", facing[one], facing[other])
    closed_mm = rule.closing_mm * np.minimum(2.0, apart * 4 / 3)
    early = rule.layer_mm * (slope[one] + slope[other]) > 2 * rule.off_mm - closed_mm
    found = np.zeros(len(surface.vertices), dtype=bool)
    found[corner[one[early]]] = True
    return found


def _walls(surface: VoidSurface, tan: float) -> tuple[Int, Float, Float, Bool]:
    """Faces and keels that may form a groove, one row for each of their corners.

    Returns (k,) the vertex, (k,) the slope, (k, 2) unit vectors of the direction they face, and
    (k,) whether they lean more than t.
    """
    least = 2 * tan - surface.steepest
    wall = np.flatnonzero((surface.slope > least) & ~surface.shallow)
    ends, lean, normals = surface.keels
    keel = (lean > KEEL * tan) & (lean <= surface.steepest)
    corner = np.concatenate([surface.faces[wall].ravel(), ends[keel].ravel()])
    slope = np.concatenate([np.repeat(surface.slope[wall], 3), np.repeat(lean[keel], 2)])
    facing = np.concatenate(
        [np.repeat(surface.normals[wall, :2], 3, axis=0), np.repeat(normals[keel, :2], 2, axis=0)]
    )
    facing = facing / np.maximum(np.linalg.norm(facing, axis=1, keepdims=True), 1e-300)
    return corner, slope, facing, slope > tan + _SAME
