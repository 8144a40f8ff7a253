"""The edges of a support polygon as linear constraints on mass and first moments."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float


# Toward the sides a directed lean does not go, a body must still stand upright; a thousandth of the
# lean there keeps every row of the program of one kind.
ASIDE = 1e-3


@dataclass(frozen=True, eq=False)
class Footing:
    """What a balance must know of the ground: (k, 2) outward unit normals and (k,) offsets, mm.

    An edge's line is {x : normal · x = offset}; the body's foot lies on the inner side.
    share : (k,) of the lean's tangent that falls on each edge, 1 for a lean in every direction,
    normal · direction for a lean in one.
    """

    normals: Float
    offsets_mm: Float
    share: Float | None = None

    @staticmethod
    def around(polygon_mm: Float) -> Footing:
        """The edges of a convex polygon (k, 2), counter-clockwise; edge i runs from i to i + 1."""
        along = np.roll(polygon_mm, -1, axis=0) - polygon_mm
        outward = np.stack([along[:, 1], -along[:, 0]], axis=1)
        normals = outward / np.linalg.norm(outward, axis=1, keepdims=True)
        return Footing(normals, np.einsum("ij,ij->i", normals, polygon_mm))

    def toward(self, azimuth_deg: float | None) -> Footing:
        """The same edges for a lean toward one azimuth, from +x counter-clockwise; None: all."""
        if azimuth_deg is None:
            return replace(self, share=None)
        azimuth = np.radians(azimuth_deg)
        along = self.normals @ np.array([np.cos(azimuth), np.sin(azimuth)])
        return replace(self, share=np.maximum(along, ASIDE))

    def constraints(self, lean_deg: float) -> Float:
        """(k, 4) rows H with H s ≥ 0 exactly when s stands at the lean."""
        share = np.ones(len(self.offsets_mm)) if self.share is None else self.share
        tangent = share * np.tan(np.radians(lean_deg))
        return np.hstack([self.offsets_mm[:, None], -self.normals, -tangent[:, None]])

    def tangent(self, moments: Float) -> float:
        """Tangent of the tilt angle of a body with moments (4,): of the lean at which it tips."""
        share = 1.0 if self.share is None else self.share
        return float(np.min(self.constraints(0.0) @ moments / share) / moments[3])
