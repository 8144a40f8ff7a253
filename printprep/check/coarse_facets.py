"""Rule: facets deviate from a round shape by less than a layer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.measure import area_normals, arrays
from printprep.mesh.weld import opposite_edges
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A sharper bend is an edge that the model means to have; a flatter bend is invisible.
_SHARPEST_DEG, _FLATTEST_DEG = 40.0, 1.0
# The least deviation that the eye sees, where layers are finer.
_VISIBLE_MM = 0.1
# This much of the surface must be coarse, in this many facets; less is a shape with flat sides.
LEAST_SHARE = 0.1
LEAST_FACETS = 12


@rule("coarse-facets")
def coarse_facets(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that facets will be visible on a surface that is probably meant to be round.

    Between two facets of width w that bend by δ, a round surface would rise by w δ / 8 above the
    chord.  A facet is coarse where it deviates by more than a layer, and by more than the eye sees.
    """
    limit = max(profile.printer.layer_height_mm, _VISIBLE_MM)
    deviation, area, facet = _deviations(*arrays(context.outside))
    coarse = deviation > limit
    share = float(area[coarse].sum() / area.sum()) if len(area) else 0.0
    if share < LEAST_SHARE or len(np.unique(facet[coarse])) < LEAST_FACETS:
        return
    typical = float(np.percentile(deviation[coarse], 50))
    yield finding(
        "coarse-facets",
        f"On {100 * share:.0f} % of the surface, facets deviate from a round shape by "
        f"{typical:.2g} mm: they will be visible.",
        "If the model is meant to be round, export it with a finer tolerance.",
        value=typical,
        limit=limit,
        area_mm2=float(area[coarse].sum()),
    )


def _deviations(vertices: Float, faces: Int) -> tuple[Float, Float, Int]:
    """How far each triangle deviates from a round surface, its area, and its facet.

    vertices : (n, 3) mm;  faces : (m, 3).
    Returns (m,) deviation in mm, 0 where flat or sharp;  (m,) area in mm²;  (m,) facet index.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    corners = vertices[faces]
    normals = area_normals(corners)
    doubled = np.linalg.norm(normals, axis=1)
    unit = normals / np.maximum(doubled, np.finfo(np.float64).tiny)[:, None]
    edge, opposite = opposite_edges(faces)
    a, b = edge // 3, opposite // 3
    start, end = faces[a, edge % 3], faces[a, (edge + 1) % 3]
    length = np.linalg.norm(vertices[end] - vertices[start], axis=1)
    bend = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", unit[a], unit[b]), -1, 1)))
    width = (doubled[a] + doubled[b]) / (2 * np.maximum(length, np.finfo(np.float64).tiny))
    round_ = (bend > _FLATTEST_DEG) & (bend < _SHARPEST_DEG)
    deviation = np.zeros(len(faces))
    for side in (a, b):
        np.maximum.at(deviation, side, np.where(round_, width * np.radians(bend) / 8, 0))
    flat = bend <= _FLATTEST_DEG
    graph = coo_matrix((np.ones(flat.sum()), (a[flat], b[flat])), shape=(len(faces),) * 2)
    facet = connected_components(graph, directed=False)[1].astype(np.int64)
    return deviation, doubled / 2, facet
