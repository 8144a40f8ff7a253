"""Triangles without area, turned into ones that have some; the surface stays where it is.

A triangle (a, b, c) whose corner c lies on its own edge ab closes a T: on one side the edge runs
through c, on the other past it.  Dropping it would open the surface, and left to itself the
boolean kernel collapses it, at times together with a corner of the model (measured: 71 mm off on
a conveyor of 1.5 m with 34 of them).  Flipping the edge it shares with its neighbour (b, a, d)
gives (c, a, d) and (b, c, d): the neighbour is cut in two at c, and nothing else changes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.types import Bool, Float, Int

# Height below which a triangle has no area, relative to the largest coordinate; above the 1e-12
# that manifold3d works to, and far below any printer.
_HEIGHT = 1e-11


def without_slivers(vertices: Float, faces: Int) -> Int:
    """Faces (m, 3) with every zero-area triangle flipped away that can be.

    One stays where the flip has no single neighbour, or would double an edge that is there.
    """
    height = _HEIGHT * float(np.abs(vertices).max())
    slivers = np.flatnonzero(_flat(vertices[faces], height)).tolist()
    if not slivers:
        return faces
    mesh = _Mesh(vertices, faces, height)
    while slivers:
        # A sliver next to a sliver waits until the other has been given some area.
        left = [index for index in slivers if not mesh.flip(index)]
        if len(left) == len(slivers):
            break
        slivers = left
    return mesh.faces


class _Mesh:
    """Faces and which of them has a directed edge; None where several have it."""

    def __init__(self, vertices: Float, faces: Int, height: float) -> None:
        self.vertices = vertices
        self.faces = faces.copy()
        self._height = height
        self._owner: dict[tuple[int, int], int | None] = {}
        for index, (a, b, c) in enumerate(faces.tolist()):
            for edge in ((a, b), (b, c), (c, a)):
                self._owner[edge] = None if edge in self._owner else index

    def flip(self, index: int) -> bool:
        """Flip the longest edge of a sliver, if both triangles that result have area."""
        a, b, c = self._longest_first(index)
        other = self._owner.get((b, a))
        if other is None or self._owner.get((a, b)) != index:
            return False
        (d,) = set(self.faces[other].tolist()) - {a, b}
        if (c, d) in self._owner or (d, c) in self._owner:
            return False
        pair = np.array([(c, a, d), (b, c, d)], dtype=np.int64)
        if _flat(self.vertices[pair], self._height).any():
            return False
        self.faces[[index, other]] = pair
        del self._owner[a, b], self._owner[b, a]
        self._owner |= {(c, a): index, (a, d): index, (d, c): index}
        self._owner |= {(b, c): other, (c, d): other, (d, b): other}
        return True

    def _longest_first(self, index: int) -> tuple[int, int, int]:
        """Its corners in order, beginning with the two ends of its longest edge."""
        corners = self.vertices[self.faces[index]]
        sides = np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1)
        a, b, c = np.roll(self.faces[index], -int(sides.argmax())).tolist()
        return a, b, c


def _flat(corners: Float, height: float) -> Bool:
    """(m,) whether triangles (m, 3, 3) are lower than ``height`` over their longest edge."""
    sides = np.roll(corners, -1, axis=1) - corners
    longest = np.linalg.norm(sides, axis=2).max(axis=1)
    result: Bool = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) <= height * longest
    return result
