"""Where alone a void can have what the acceptance rule flags: shallow faces, keels and tips.

Notation: t = (off − c) / h, the tangent of the steepest overhang that always passes (limits.py); a
way down falls at least as steeply as that, |Δxy| ≤ t |Δz|.

From a point of the ceiling follow ways down on the surface.  A face that leans no more than t has
one, its line of steepest descent, until it ends at an edge.  Either a face beyond goes on down, or
both faces fall toward the edge, a keel of material that hangs in the void, and the edge itself must
be a way down; a corner has one where an edge or a face that meets there does.  Where that never
fails there is material a layer deeper within h · t = off − c, so nothing of the layer above is
flagged.  Hence every flagged point lies within off of a shallow face, of a keel that is no way
down, or of a tip without any; all others need not be sliced.

A keel between faces that just pass, as on a funnel's polygon, leans a little more than they do; up
to ``KEEL`` times t it passes: what sticks out is a corner of a few µm.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.mesh.weld import directed_edges

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.overhang.limits import Acceptance
    from printprep.types import Bool, Float, Int

KEEL = 1.05
_EXACT = 1e-9
# The window around suspects is made of cells of these sides.
CELL_MM = np.array([2.0, 2.0, 0.4])


@dataclass(frozen=True, eq=False)
class Suspects:
    """low_mm, high_mm : (n, 3) boxes around the faces, edges and corners in question."""

    low_mm: Float
    high_mm: Float

    def __len__(self) -> int:
        return len(self.low_mm)

    @staticmethod
    def of(void: Manifold, rule: Acceptance) -> Suspects:
        """All of a void's surface."""
        vertices, faces = arrays(void)
        if len(faces) == 0:
            return Suspects(np.zeros((0, 3)), np.zeros((0, 3)))
        surface = _Surface.of(vertices, faces, (rule.off_mm - rule.closing_mm) / rule.layer_mm)
        boxes = [
            vertices[faces[surface.shallow]],
            vertices[surface.keels()],
            vertices[surface.tips()][:, None],
        ]
        return Suspects(
            np.concatenate([box.min(axis=1) for box in boxes]),
            np.concatenate([box.max(axis=1) for box in boxes]),
        )

    def near(self, low_mm: Float, high_mm: Float) -> Suspects:
        """Those that meet any of the boxes (k, 3)."""
        met = np.zeros(len(self), dtype=bool)
        for low, high in zip(low_mm, high_mm, strict=True):
            met |= ((self.low_mm <= high) & (self.high_mm >= low)).all(axis=1)
        return Suspects(self.low_mm[met], self.high_mm[met])

    def window(self, around_mm: Float) -> Manifold:
        """A solid that reaches ``around_mm`` (3,) at least beyond every suspect's box."""
        from manifold3d import Manifold, OpType

        first = np.floor((self.low_mm - around_mm) / CELL_MM).astype(np.int64)
        last = np.floor((self.high_mm + around_mm) / CELL_MM).astype(np.int64)
        boxes = []
        for low, high in _bricks(first, last):
            cube = Manifold.cube((CELL_MM * (high - low)).tolist())
            boxes.append(cube.translate((CELL_MM * low).tolist()))
        return Manifold.batch_boolean(boxes, OpType.Add) if boxes else Manifold()


@dataclass(frozen=True, eq=False)
class _Surface:
    """A closed mesh with unit normals, seen as ceilings; shallow : (m,) faces that lean too far."""

    vertices: Float
    faces: Int
    normals: Float
    tan: float
    shallow: Bool

    @staticmethod
    def of(vertices: Float, faces: Int, tan: float) -> _Surface:
        a, b, c = (vertices[faces[:, k]] for k in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
        level = np.hypot(normals[:, 0], normals[:, 1])
        return _Surface(vertices, faces, normals, tan, normals[:, 2] > tan * level + _EXACT)

    def keels(self) -> Int:
        """(k, 2) ends of hanging edges from which neither face nor the edge is a way down."""
        edges = directed_edges(self.faces)
        face = np.arange(len(edges)) // 3
        opposite = self.faces[:, [2, 0, 1]].ravel()
        ends = np.sort(edges, axis=1)
        order = np.argsort(ends[:, 0] * len(self.vertices) + ends[:, 1], kind="stable")
        one, other = order[0::2], order[1::2]
        mine, theirs = self.normals[face[one]], self.normals[face[other]]
        away = self.vertices[opposite[other]] - self.vertices[ends[one, 0]]
        hanging = np.einsum("ij,ij->i", mine, away) > 0  # the void bends around material
        hanging &= (mine[:, 2] > 0) | (theirs[:, 2] > 0)
        hanging &= ~self.shallow[face[one]] & ~self.shallow[face[other]]
        one, mine, theirs = one[hanging], mine[hanging], theirs[hanging]
        kept = ~(_falls_into(mine, theirs) | _falls_into(theirs, mine))
        found = ends[one[kept]]
        way = self.vertices[found[:, 1]] - self.vertices[found[:, 0]]
        level, fall = np.hypot(way[:, 0], way[:, 1]), np.abs(way[:, 2])
        result: Int = found[level > KEEL * self.tan * fall]
        return result

    def tips(self) -> Int:
        """(k,) corners of ceilings from which no edge and no face is a way down."""
        held = np.zeros(len(self.vertices), dtype=bool)
        edges = directed_edges(self.faces)
        way = self.vertices[edges[:, 1]] - self.vertices[edges[:, 0]]
        level = np.hypot(way[:, 0], way[:, 1])
        held[edges[level <= -KEEL * self.tan * way[:, 2], 0]] = True
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
    """Whether from an edge the way down on one face stays in its material, under the other face.

    In the plane one below the edge material is where n · (x, y) ≥ n_z for both normals; the point
    of the one boundary nearest to the edge must lie within the other.
    """
    level = np.maximum((mine[:, :2] ** 2).sum(axis=1), 1e-300)
    nearest = mine[:, :2] * (np.maximum(mine[:, 2], 0.0) / level)[:, None]
    result: Bool = (theirs[:, :2] * nearest).sum(axis=1) >= theirs[:, 2] - _EXACT
    return result


def _bricks(first: Int, last: Int) -> list[tuple[Int, Int]]:
    """Cells within any of the boxes first..last (n, 3), as disjoint rows along z, [low, high)."""
    first, last = (part.reshape(-1, 3) for part in (first, last))
    cells = []
    size = last - first + 1
    for shape in np.unique(size, axis=0):
        own = first[(size == shape).all(axis=1)]
        steps = np.stack(np.meshgrid(*map(np.arange, shape), indexing="ij"), axis=-1).reshape(-1, 3)
        cells.append((own[:, None] + steps).reshape(-1, 3))
    if not cells:
        return []
    every = np.unique(np.concatenate(cells), axis=0)
    same = (every[1:, :2] == every[:-1, :2]).all(axis=1) & (every[1:, 2] == every[:-1, 2] + 1)
    starts = np.flatnonzero(np.concatenate([[True], ~same]))
    ends = np.append(starts[1:], len(every)) - 1
    return [(every[a], every[b] + 1) for a, b in zip(starts, ends, strict=True)]
