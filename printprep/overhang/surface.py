"""The surface of a void: slopes of its ceilings, keels of material that hang in it, and tips.

A *way down* is a path on the surface that falls steeply enough: |Δxy| ≤ steepest · |Δz|.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals
from printprep.mesh.weld import directed_edges, opposite_edges

if TYPE_CHECKING:
    from printprep.arrays import Bool, Float, Int

_EXACT = 1e-9


@dataclass(frozen=True, eq=False)
class VoidSurface:
    """The closed surface of a void.

    vertices : (n, 3), x, y, z in mm;  faces : (m, 3), counter-clockwise seen from outside the void;
    normals : (m, 3), of unit length;  steepest : largest tangent of a way down, from the vertical.
    """

    vertices: Float
    faces: Int
    normals: Float
    steepest: float

    @staticmethod
    def of(vertices: Float, faces: Int, steepest: float) -> VoidSurface:
        """The surface with its normals; vertices : (n, 3) mm, faces : (m, 3)."""
        normals = area_normals(vertices[faces])
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        return VoidSurface(vertices, faces, normals, steepest)

    @cached_property
    def slope(self) -> Float:
        """(m,) tangents of the overhang of faces, from the vertical; negative for floors."""
        level = np.hypot(self.normals[:, 0], self.normals[:, 1])
        result: Float = self.normals[:, 2] / np.maximum(level, 1e-300)
        return result

    @cached_property
    def shallow(self) -> Bool:
        """(m,) whether a face is a ceiling too flat to be a way down."""
        level = np.hypot(self.normals[:, 0], self.normals[:, 1])
        result: Bool = self.normals[:, 2] > self.steepest * level + _EXACT
        return result

    @cached_property
    def keels(self) -> tuple[Int, Float, Float]:
        """Hanging edges between two faces steep enough, neither of which falls into the other.

        Returns (k, 2) their ends, (k,) the tangents of their own overhang, and (k, 3) the sums of
        the normals on both sides.
        """
        ends = np.sort(directed_edges(self.faces), axis=1)
        opposite = self.faces[:, [2, 0, 1]].ravel()
        one, other = opposite_edges(self.faces)
        mine, theirs = self.normals[one // 3], self.normals[other // 3]
        away = self.vertices[opposite[other]] - self.vertices[ends[one, 0]]
        hanging = np.einsum("ij,ij->i", mine, away) > 0  # the void bends around material
        hanging &= (mine[:, 2] > 0) | (theirs[:, 2] > 0)
        hanging &= ~self.shallow[one // 3] & ~self.shallow[other // 3]
        one, mine, theirs = one[hanging], mine[hanging], theirs[hanging]
        kept = ~(_falls_into(mine, theirs) | _falls_into(theirs, mine))
        found = ends[one[kept]]
        way = self.vertices[found[:, 1]] - self.vertices[found[:, 0]]
        fall = np.maximum(np.abs(way[:, 2]), 1e-300)
        return found, np.hypot(way[:, 0], way[:, 1]) / fall, mine[kept] + theirs[kept]

    def steep_keels(self) -> Int:
        """(k, 2) ends of the keels that are too flat to be a way down."""
        ends, slope, _ = self.keels
        return ends[slope > self.steepest]

    def tips(self) -> Int:
        """(k,) vertices of ceilings from which neither an edge nor a face gives a way down."""
        held = np.zeros(len(self.vertices), dtype=bool)
        edges = directed_edges(self.faces)
        way = self.vertices[edges[:, 1]] - self.vertices[edges[:, 0]]
        level = np.hypot(way[:, 0], way[:, 1])
        held[edges[level <= -self.steepest * way[:, 2], 0]] = True
        steep = np.flatnonzero(~self.shallow)
        normals = self.normals[steep]
        down = normals * normals[:, 2:] - np.array([0.0, 0.0, 1.0])  # steepest descent
        for k in range(3):
            corner, after, before = (self.faces[steep, (k + turn) % 3] for turn in range(3))
            left = self.vertices[after] - self.vertices[corner]
            right = self.vertices[before] - self.vertices[corner]
            within = np.einsum("ij,ij->i", np.cross(left, down), normals) >= -_EXACT
            within &= np.einsum("ij,ij->i", np.cross(down, right), normals) >= -_EXACT
            held[corner[within]] = True
        ceiling = np.zeros(len(self.vertices), dtype=bool)
        ceiling[self.faces[self.normals[:, 2] > 0]] = True
        return np.flatnonzero(ceiling & ~held)


def _falls_into(mine: Float, theirs: Float) -> Bool:
    """(k,) whether the way down from an edge on one face stays in material, under the other face.

    mine, theirs : (k, 3) normals of the two faces.  In the plane one unit below the edge, material
    is where n · (x, y) ≥ n_z for both normals; the point of the first boundary nearest to the edge
    must lie inside the second one.
    """
    level = np.maximum((mine[:, :2] ** 2).sum(axis=1), 1e-300)
    nearest = mine[:, :2] * (np.maximum(mine[:, 2], 0.0) / level)[:, None]
    result: Bool = (theirs[:, :2] * nearest).sum(axis=1) >= theirs[:, 2] - _EXACT
    return result
