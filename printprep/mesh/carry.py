"""Carries the paint of a mesh to another one whose outside is the same surface.

The facets of a part's outside are facets of the model or pieces of them: the boolean kernel cuts
facets, moves none, and joins none of those that :func:`facets_apart` gave an id each.  So each
facet takes the style of the facet of the model that it lies on.  A facet that lies on none (a base,
a cavity, a drain) stays plain; one that lies on several styles takes that of most of its area.
Codes of paint that split a triangle hold only for the triangle that they were made for, corner by
corner.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import area_normals, arrays
from printprep.types import Paint, Style

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Bool, Float, Int

# Facets of a written part lie on the model to float32; a repair may move it by more.
_ON_MM = 2e-3
_SAME_SIDE = 0.9  # cosine between the normals of a facet and of the one it lies on
# Where a facet is sampled, as weights of its corners: the middle, and near corners and edges.
_SAMPLES = np.array(
    [
        [1 / 3, 1 / 3, 1 / 3],
        [0.8, 0.1, 0.1],
        [0.1, 0.8, 0.1],
        [0.1, 0.1, 0.8],
        [0.45, 0.45, 0.1],
        [0.1, 0.45, 0.45],
        [0.45, 0.1, 0.45],
    ]
)


@dataclass(frozen=True, eq=False)
class Carried:
    """The paint of a part.

    styles : of its faces;  labels : (m,) into ``styles``;  turns : (m,) by how many corners each
    face must be turned so that it begins as the model's facet does (for codes that split it).
    lost_mm2, painted_mm2 : painted area of the model's outside that is not carried as it was, and
    all of it.
    """

    styles: tuple[Style, ...]
    labels: Int
    turns: Int
    lost_mm2: float
    painted_mm2: float


def carried(
    paint: Paint,
    vertices: Float,
    faces: Int,
    to_vertices: Float,
    to_faces: Int,
    slack_mm: float = 0.0,
) -> Carried:
    """Carry paint from a mesh to another one in the same place.

    vertices : (n, 3) mm;  faces : (m, 3);  slack_mm : how far the surface was moved between them.
    """
    import igl

    corners = to_vertices[to_faces]
    points = np.einsum("sk,fkx->fsx", _SAMPLES, corners)
    squared, nearest, _ = igl.point_mesh_squared_distance(
        np.ascontiguousarray(points.reshape(-1, 3)),
        np.ascontiguousarray(vertices, dtype=np.float64),
        np.ascontiguousarray(faces, dtype=np.int64),
    )
    nearest = np.asarray(nearest, dtype=np.int64)
    normals, to_normals = _unit(vertices[faces]), _unit(corners)
    side = np.einsum("fsx,fx->fs", normals[nearest].reshape(*points.shape), to_normals)
    away = np.sqrt(np.maximum(squared, 0)).reshape(side.shape)
    on = (away <= _ON_MM + slack_mm) & ((side >= _SAME_SIDE) | (slack_mm > 0) & (side > 0))
    found = np.where(on, paint.labels[nearest].reshape(side.shape), 0)
    labels, others = _most(found)
    turns = np.zeros(len(to_faces), dtype=np.int64)
    styles = list(paint.styles)
    split = np.array([style.splits for style in styles])
    if split.any():
        middle = vertices[faces[nearest.reshape(side.shape)[:, 0]]]
        labels, turns, kept = _whole_only(split, styles, labels, corners, middle)
        others[~kept] = 1.0
    areas = np.linalg.norm(area_normals(corners), axis=1) / 2
    painted = (found != 0).any(axis=1)
    return Carried(
        tuple(styles),
        labels,
        turns,
        float((areas * others)[painted].sum()),
        float(areas[painted].sum()),
    )


def facets_apart(manifold: Manifold) -> Manifold:
    """The same manifold, whose facets keep their edges in every boolean, flat as they may be."""
    from manifold3d import Manifold, Mesh64

    vertices, faces = arrays(manifold)
    return Manifold(
        Mesh64(
            np.require(vertices, np.float64, ["C", "W"]),
            np.require(faces, np.uint64, ["C", "W"]),
            face_id=np.arange(len(faces), dtype=np.uint64),
        )
    )


def _most(found: Int) -> tuple[Int, Float]:
    """(m,) the label that most samples of a row of found (m, s) have; the share of the others."""
    ordered = np.sort(found, axis=1)
    best = ordered[:, 0].copy()
    most = np.zeros(len(found), dtype=np.int64)
    for column in range(found.shape[1]):
        count = (found == ordered[:, column : column + 1]).sum(axis=1)
        better = count > most
        best[better], most[better] = ordered[better, column], count[better]
    return best, 1 - most / found.shape[1]


def _whole_only(
    split: Bool, styles: list[Style], labels: Int, corners: Float, of_model: Float
) -> tuple[Int, Int, Bool]:
    """Labels (m,), turns (m,), and which are as they were, where codes that split need it.

    split : which styles have such a code;  corners : (m, 3, 3) of the part's faces;  of_model :
    (m, 3, 3) of the model's facet under the middle of each.
    A style whose code would not fit keeps what does not split; new styles are added to ``styles``.
    """
    labels, turns = labels.copy(), np.zeros(len(labels), dtype=np.int64)
    kept = np.ones(len(labels), dtype=bool)
    numbers = {style: number for number, style in enumerate(styles)}
    same = np.stack(
        [np.abs(np.roll(corners, -turn, axis=1) - of_model).max(axis=(1, 2)) for turn in range(3)]
    )
    for face in np.flatnonzero(split[labels]):
        turn = int(same[:, face].argmin())
        if same[turn, face] <= _ON_MM:
            turns[face] = turn
            continue
        rest = styles[labels[face]].whole
        if rest not in numbers:
            numbers[rest] = len(styles)
            styles.append(rest)
        labels[face], kept[face] = numbers[rest], False
    return labels, turns, kept


def _unit(corners: Float) -> Float:
    """(m, 3) unit normals of triangles (m, 3, 3), zero where they have no area."""
    normals = area_normals(corners)
    length = np.linalg.norm(normals, axis=1, keepdims=True)
    result: Float = np.divide(normals, length, out=np.zeros_like(normals), where=length > 0)
    return result
