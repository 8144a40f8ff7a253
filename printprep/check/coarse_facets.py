"""Rule: the mesh is as fine as the layers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.measure import arrays
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.arrays import Float, Int
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A bend sharper than this is an edge that is meant; one flatter is not seen.
_SHARPEST_DEG, _FLATTEST_DEG = 40.0, 1.0
# What an eye sees where layers are finer.
_SEEN_MM = 0.1
# So much of the surface must be coarse, in so many facets: fewer are a shape with flat sides.
LEAST_SHARE = 0.1
LEAST_FACETS = 12


@rule("coarse-facets")
def coarse_facets(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that facets will be seen where the model means to be round.

    Between two facets of width w that bend by δ, a round surface would rise by w δ / 8 above the
    chord; coarse is what misses by more than a layer, or than an eye sees.
    """
    limit = max(profile.printer.layer_height_mm, _SEEN_MM)
    miss, area, facet = _misses(*arrays(context.outside))
    coarse = miss > limit
    share = float(area[coarse].sum() / area.sum()) if len(area) else 0.0
    if share < LEAST_SHARE or len(np.unique(facet[coarse])) < LEAST_FACETS:
        return
    worst = float(np.percentile(miss[coarse], 50))
    yield finding(
        "coarse-facets",
        f"{100 * share:.0f} % of its surface is coarser than the print: facets miss a round shape "
        f"by {worst:.2g} mm and will be seen.",
        "Export the model with a finer tolerance, if it is meant to be round.",
        value=worst,
        limit=limit,
        area_mm2=float(area[coarse].sum()),
    )


def _misses(vertices: Float, faces: Int) -> tuple[Float, Float, Int]:
    """(m,) how far each triangle misses a round surface, 0 where flat or sharp; area; facet."""
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    corners = vertices[faces]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    doubled = np.linalg.norm(normals, axis=1)
    unit = normals / np.maximum(doubled, np.finfo(np.float64).tiny)[:, None]
    start, end = faces.ravel(), np.roll(faces, -1, axis=1).ravel()
    owner = np.repeat(np.arange(len(faces)), 3)
    order = np.argsort(np.minimum(start, end) * len(vertices) + np.maximum(start, end))
    a, b = owner[order][::2], owner[order][1::2]
    length = np.linalg.norm(vertices[end] - vertices[start], axis=1)[order][::2]
    bend = np.degrees(np.arccos(np.clip(np.einsum("ij,ij->i", unit[a], unit[b]), -1, 1)))
    width = (doubled[a] + doubled[b]) / (2 * np.maximum(length, np.finfo(np.float64).tiny))
    round_ = (bend > _FLATTEST_DEG) & (bend < _SHARPEST_DEG)
    miss = np.zeros(len(faces))
    for side in (a, b):
        np.maximum.at(miss, side, np.where(round_, width * np.radians(bend) / 8, 0))
    flat = bend <= _FLATTEST_DEG
    graph = coo_matrix((np.ones(flat.sum()), (a[flat], b[flat])), shape=(len(faces),) * 2)
    return miss, doubled / 2, connected_components(graph, directed=False)[1].astype(np.int64)
