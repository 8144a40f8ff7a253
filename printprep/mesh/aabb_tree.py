"""A mesh in search trees: nearest points, and first hits of rays.

Nearest points come from libigl's tree of boxes.  Rays go through Embree (Wald et al., "Embree: a
kernel framework for efficient CPU ray tracing", 2014), which calculates in single precision; the
place of a hit is then calculated again in double precision.  On processors that Embree is not built
for, rays go through libigl's tree too, about twenty times as slowly.
"""

from __future__ import annotations

import threading
from dataclasses import dataclass
from functools import cached_property
from hashlib import blake2b
from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.arrays import stable_order
from printprep.kept import may_change
from printprep.mesh.measure import area_normals
from printprep.mesh.weld import connected

if TYPE_CHECKING:
    from collections.abc import Sequence
    from typing import TypeVar

    from printprep.arrays import Bool, Float, Int

    Rows = TypeVar("Rows", Float, Int)

# A triangle is long where an edge is longer than the mesh's longest side over this.
LONG_SHARE = 10
# Halving stops before a mesh has so many times its triangles, and so many more.
MOST_PIECES = 2
FEW_FACES = 20_000
# From so many triangles on, it pays to put them in order first, and shells into trees of their own
# where these are few.
MANY_FACES = 100_000
MOST_SHELLS = 8


def tree_of(vertices: Float, faces: Int) -> SurfaceTree:
    """The search tree of a mesh; the trees of the last few meshes are kept.

    vertices : (n, 3) mm;  faces : (m, 3).
    """
    vertices = np.ascontiguousarray(vertices, dtype=np.float64)
    faces = np.ascontiguousarray(faces, dtype=np.int64)
    key = blake2b(vertices.data, digest_size=16).digest() + blake2b(faces.data).digest()
    with _ONE_AT_A_TIME:  # a thread that wants the tree that another one builds waits for it
        # A copy: the caller may move his corners afterwards, and the tree is still that of this
        # mesh.
        found = _KEPT.pop(key, None) or _grown(_unchanging(vertices), _unchanging(faces))
        _KEPT[key] = found  # the last used are at the end
        while len(_KEPT) > _MOST_TREES or (len(_KEPT) > 1 and _held_faces() > _MOST_FACES):
            del _KEPT[next(iter(_KEPT))]
    return found


def _held_faces() -> int:
    """The triangles of all trees that are kept; trees of shells may be held by several."""
    held = {id(tree): tree for kept in _KEPT.values() for tree in kept.trees}
    return sum(len(tree.faces) for tree in held.values())


def _grown(vertices: Float, faces: Int) -> SurfaceTree:
    """The tree of a mesh, or the trees of its few shells where they are large.

    The outside of a part is a large shell that is searched alone too: its tree serves for both.
    """
    if len(faces) < MANY_FACES:
        return SurfaceTree(vertices, faces)
    a, b, c = faces.T
    label = connected(np.append(a, b), np.append(b, c), len(vertices))
    shells = np.flatnonzero(np.bincount(label[a]))
    if not 1 < len(shells) <= MOST_SHELLS:
        return SurfaceTree(vertices, faces)
    grown, owner = [], []
    for shell in shells.tolist():
        corners, own = label == shell, np.flatnonzero(label[a] == shell)
        number = np.cumsum(corners) - 1
        grown.append(tree_of(vertices[corners], number[faces[own]]))
        owner.append(own)
    return _ShellTrees(vertices, faces, grown, owner)


def _unchanging(array: Rows) -> Rows:
    """An array that may change as a copy."""
    return array.copy() if may_change(array) else array


class SurfaceTree:
    """The triangles of a mesh in a search tree, which is built once."""

    def __init__(self, vertices: Float, faces: Int) -> None:
        """vertices : (n, 3) mm;  faces : (m, 3)."""
        import igl

        self.vertices = np.ascontiguousarray(vertices, dtype=np.float64)
        self.faces = np.ascontiguousarray(faces, dtype=np.int64)
        self._pieces = _nearby_together(_bisected(self.vertices, self.faces))
        self._tree: Any = igl.AABB()
        self._tree.init(self._pieces.vertices, self._pieces.faces)
        # A ray that starts on the surface is moved forward by this much.
        self._centre_mm = (self.vertices.min(axis=0) + self.vertices.max(axis=0)) / 2
        self._beyond_mm = 1e-6 * float(np.ptp(vertices, axis=0).max())

    @property
    def trees(self) -> Sequence[SurfaceTree]:
        """The trees that it consists of."""
        return (self,)

    def nearest(self, points: Float) -> tuple[Float, Float]:
        """(k,) exact distances of points (k, 3) mm, and (k, 3) the nearest points of the mesh."""
        distance, closest, _ = self.nearest_faces(points)
        return distance, closest

    def nearest_faces(self, points: Float) -> tuple[Float, Float, Int]:
        """The same, and (k,) the face that the nearest point lies on."""
        if len(points) == 0:
            return np.zeros(0), np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
        squared, piece, closest = self._tree.squared_distance(
            self._pieces.vertices, self._pieces.faces, np.ascontiguousarray(points)
        )
        distance = np.sqrt(np.maximum(np.ravel(squared), 0.0))
        return distance, np.reshape(closest, (-1, 3)), self._pieces.owner[np.ravel(piece)]

    def first_hit(self, points: Float, directions: Float) -> tuple[Float, Int]:
        """(k,) mm to the first hit of each ray, and (k,) the face that it hits.

        points : (k, 3) mm, starts of the rays;  directions : (k, 3) unit vectors.  A ray without a
        hit gets inf and −1.  A ray may start on the surface: the place it starts from is no hit.
        """
        if len(points) == 0:
            return np.zeros(0), np.zeros(0, dtype=np.int64)
        starts = np.ascontiguousarray(points + self._beyond_mm * directions)
        if self._scene is None:
            return self.first_hit_exactly(points, directions)
        face = self._cast(starts, directions, np.inf)
        far = np.full(len(points), np.inf)
        hit = np.flatnonzero(face >= 0)
        corner = self.vertices[self.faces[face[hit], 0]]
        normal = area_normals(self.vertices[self.faces[face[hit]]])
        across = np.einsum("ij,ij->i", normal, directions[hit])
        along = np.einsum("ij,ij->i", normal, corner - points[hit])
        far[hit] = np.divide(along, across, out=np.zeros(len(hit)), where=across != 0)
        return np.where(np.isfinite(far), np.maximum(far, self._beyond_mm), far), face

    def first_hit_exactly(self, points: Float, directions: Float) -> tuple[Float, Int]:
        """The same in double precision throughout, for rays that graze the surface."""
        if len(points) == 0:
            return np.zeros(0), np.zeros(0, dtype=np.int64)
        starts = np.ascontiguousarray(points + self._beyond_mm * directions)
        piece, along, _ = self._tree.intersect_ray_first(
            self._pieces.vertices,
            self._pieces.faces,
            starts,
            np.ascontiguousarray(directions),
        )
        piece = np.ravel(piece)
        face = np.where(piece >= 0, self._pieces.owner[piece], -1)
        return np.where(face >= 0, np.ravel(along) + self._beyond_mm, np.inf), face

    def may_hit(self, points: Float, directions: Float, within_mm: Float) -> Bool:
        """(k,) whether a ray may hit the surface within (k,) mm; false where it surely does not."""
        if self._scene is None:
            return np.ones(len(points), dtype=bool)
        hit: Bool = self._cast(points, directions, within_mm) >= 0
        return hit

    def _cast(self, starts: Float, directions: Float, within_mm: Float | float) -> Int:
        """(k,) the face that each ray hits first in single precision, −1 for none."""
        limits = np.empty(len(starts), dtype=np.float32)
        limits[:] = within_mm
        face = self._scene.run(
            (starts - self._centre_mm).astype(np.float32), directions.astype(np.float32), limits
        )
        return np.asarray(face).astype(np.int64)

    @cached_property
    def _scene(self) -> Any:
        """The triangles in an Embree scene, around the origin; None where it is not installed."""
        try:
            from embreex.mesh_construction import TriangleMesh
            from embreex.rtcore_scene import EmbreeScene
        except ImportError:
            return None
        scene = EmbreeScene()
        moved = (self.vertices - self._centre_mm).astype(np.float32)
        TriangleMesh(scene, moved, self.faces.astype(np.int32))
        return scene


class _ShellTrees(SurfaceTree):
    """The tree of a mesh that consists of the trees of its shells."""

    def __init__(
        self, vertices: Float, faces: Int, shells: list[SurfaceTree], owner: list[Int]
    ) -> None:
        """vertices : (n, 3) mm;  faces : (m, 3);  owner : the faces of each shell."""
        self.vertices, self.faces = vertices, faces
        self._shells, self._owner = shells, owner

    @property
    def trees(self) -> Sequence[SurfaceTree]:
        return self._shells

    def nearest_faces(self, points: Float) -> tuple[Float, Float, Int]:
        found = [shell.nearest_faces(points) for shell in self._shells]
        closest = np.argmin([distance for distance, _, _ in found], axis=0)
        return (
            _chosen(closest, [distance for distance, _, _ in found]),
            _chosen(closest, [place for _, place, _ in found]),
            _chosen(closest, self._numbered([face for _, _, face in found])),
        )

    def first_hit(self, points: Float, directions: Float) -> tuple[Float, Int]:
        return self._first([shell.first_hit(points, directions) for shell in self._shells])

    def first_hit_exactly(self, points: Float, directions: Float) -> tuple[Float, Int]:
        return self._first([shell.first_hit_exactly(points, directions) for shell in self._shells])

    def may_hit(self, points: Float, directions: Float, within_mm: Float) -> Bool:
        hits = [shell.may_hit(points, directions, within_mm) for shell in self._shells]
        result: Bool = np.logical_or.reduce(hits)
        return result

    def _first(self, found: list[tuple[Float, Int]]) -> tuple[Float, Int]:
        first = np.argmin([far for far, _ in found], axis=0)
        faces = self._numbered([face for _, face in found])
        return _chosen(first, [far for far, _ in found]), _chosen(first, faces)

    def _numbered(self, faces: list[Int]) -> list[Int]:
        """(k,) the faces of each shell, −1 for none, as those of the mesh."""
        each = zip(self._owner, faces, strict=True)
        return [np.where(face >= 0, owner[face], -1) for owner, face in each]


def _chosen(which: Int, among: list[Rows]) -> Rows:
    """For each of (k,) the row of one of several arrays of k rows."""
    result = among[0].copy()
    for number, rows in enumerate(among[1:], 1):
        chosen = which == number
        result[chosen] = rows[chosen]
    return result


@dataclass(frozen=True, eq=False)
class _Pieces:
    """Triangles, the long ones in pieces.

    vertices : (n, 3) mm;  faces : (m, 3);  owner : (m,) the triangle that each is a piece of.
    """

    vertices: Float
    faces: Int
    owner: Int


def _bisected(vertices: Float, faces: Int) -> _Pieces:
    """Triangles (m, 3) with the long ones halved until none is long, in a soup.

    A box of the tree around a long triangle holds many small ones that are not near it: in a tree
    of pieces a nearest point is found up to four times as fast.
    """
    pieces = _Pieces(vertices, faces, np.arange(len(faces)))
    if not len(faces):
        return pieces
    long_mm = float(np.ptp(vertices, axis=0).max()) / LONG_SHARE
    every, owner, some = faces, pieces.owner, np.arange(len(faces))
    while True:
        a, b, c = (vertices[every[some, corner]] for corner in range(3))
        edges = np.stack([((p - q) ** 2).sum(axis=1) for p, q in ((a, b), (b, c), (c, a))])
        long = edges.max(axis=0) > long_mm**2
        some, first = some[long], edges.argmax(axis=0)[long]
        if not len(some) or len(every) + len(some) > MOST_PIECES * len(faces) + FEW_FACES:
            return _Pieces(vertices, every, owner)
        a, b, c = (every[some, (first + step) % 3] for step in range(3))
        middle = len(vertices) + np.arange(len(some))
        vertices = np.concatenate([vertices, (vertices[a] + vertices[b]) / 2])
        every = np.concatenate([every, np.stack([middle, b, c], axis=1)])
        every[some] = np.stack([a, middle, c], axis=1)
        owner = np.concatenate([owner, owner[some]])
        some = np.concatenate([some, np.arange(len(every) - len(some), len(every))])


def _nearby_together(pieces: _Pieces) -> _Pieces:
    """The same triangles and corners along a curve that fills space, where they are many.

    What lies together in space then lies together in memory: a tree of a million triangles is built
    and asked in three quarters of the time.
    """
    if len(pieces.faces) < MANY_FACES:
        return pieces
    place = _along_curve(pieces.vertices)
    number = np.empty(len(place), dtype=np.int64)
    number[place] = np.arange(len(place))
    faces = number[pieces.faces]
    order = stable_order(faces.min(axis=1))
    return _Pieces(pieces.vertices[place], faces[order], pieces.owner[order])


def _along_curve(points: Float) -> Int:
    """(n,) the order of points (n, 3) mm along a Z-order curve (Morton, 1966) of 1024³ cells."""
    low = points.min(axis=0)
    size = float(np.ptp(points, axis=0).max()) or 1.0
    cells = np.floor((points - low) * (1023 / size)).astype(np.int64)
    spread = np.zeros(1024, dtype=np.int64)
    for bit in range(10):  # bit b of a coordinate becomes bit 3b
        spread |= (np.arange(1024) >> bit & 1) << (3 * bit)
    x, y, z = (spread[cells[:, axis]] for axis in range(3))
    return stable_order(x | y << 1 | z << 2)


# So many trees are kept, as long as they have no more faces together; one takes 172 bytes for
# libigl's tree.  Embree crashes where some thousand scenes are held.
_MOST_TREES = 8
_MOST_FACES = 5_200_000
_KEPT: dict[bytes, SurfaceTree] = {}
_ONE_AT_A_TIME = threading.RLock()
