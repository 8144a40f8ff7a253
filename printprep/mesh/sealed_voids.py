"""Finds the sealed voids of a solid: those that are empty, and those that hold a body."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays, from_arrays, innermost
from printprep.mesh.shell_figures import shell_figures
from printprep.mesh.weld import compact

if TYPE_CHECKING:
    from manifold3d import Manifold


@dataclass(frozen=True, eq=False)
class SealedVoids:
    """The sealed voids of a solid, as positive solids, largest first.

    whole : the solid with its empty voids filled.
    empty : voids without anything in them;  holding : voids that hold a body of their own, as a
    rattle does, each with that body taken for filled.
    """

    whole: Manifold
    empty: tuple[Manifold, ...]
    holding: tuple[Manifold, ...]


def sealed_voids(solid: Manifold) -> SealedVoids:
    """Separate a solid from its sealed voids.

    A body belongs to the smallest void around it.  No vertex moves: the shells of empty voids are
    left out.
    """
    vertices, faces = arrays(solid)
    figures = shell_figures(vertices, faces)
    hollow = np.flatnonzero(figures.volume_mm3 < 0)
    if not len(hollow):
        return SealedVoids(solid, (), ())
    hollow = hollow[np.argsort(figures.volume_mm3[hollow], kind="stable")]
    shells = [
        from_arrays(*compact(vertices, faces[figures.label == number][:, ::-1]))
        for number in hollow.tolist()
    ]
    holds = np.zeros(len(shells), dtype=bool)
    for number in np.flatnonzero(figures.volume_mm3 >= 0).tolist():
        low, high = figures.low_mm[number], figures.high_mm[number]
        around = [
            k
            for k, void in enumerate(hollow.tolist())
            if (figures.low_mm[void] <= low).all() and (figures.high_mm[void] >= high).all()
        ]
        if around:
            body = from_arrays(*compact(vertices, faces[figures.label == number]))
            owner = innermost(body, [shells[k] for k in around])
            if owner is not None:
                holds[around[owner]] = True
    if holds.all():
        whole = solid
    else:
        left = ~np.isin(figures.label, hollow[~holds])
        whole = from_arrays(*compact(vertices, faces[left]))
    return SealedVoids(
        whole,
        tuple(shell for shell, full in zip(shells, holds, strict=True) if not full),
        tuple(shell for shell, full in zip(shells, holds, strict=True) if full),
    )
