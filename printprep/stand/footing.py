"""The edges of a support polygon as linear constraints on mass and first moments."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.arrays import Float


# A lean toward one azimuth asks little of the edges on the other sides: the body only has to stand
# upright there.  A thousandth of the lean at these edges keeps all rows of the program alike.
ASIDE = 1e-3


@dataclass(frozen=True, eq=False)
class Footing:
    """The edges of a support polygon.

    normals : (k, 2) outward unit normals;  offsets_mm : (k,).  The line of an edge is
    {x : normal · x = offset}; the foot of the body lies on the inner side.
    share : (k,) share of the lean's tangent that counts at each edge: 1 for a lean in every
    direction, normal · direction for a lean in one.
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
        """The same edges for a lean toward an azimuth (from +x counter-clockwise; None: all)."""
        if azimuth_deg is None:
            return replace(self, share=None)
        azimuth = np.radians(azimuth_deg)
        along = self.normals @ np.array([np.cos(azimuth), np.sin(azimuth)])
        return replace(self, share=np.maximum(along, ASIDE))

    def constraints(self, lean_deg: float) -> Float:
        """(k, 4) H with H s ≥ 0 exactly where a body with moments s stands at the lean.

        s : (4,) volume in mm³ and first moments x, y, z in mm⁴.
        """
        share = np.ones(len(self.offsets_mm)) if self.share is None else self.share
        tangent = share * np.tan(np.radians(lean_deg))
        return np.hstack([self.offsets_mm[:, None], -self.normals, -tangent[:, None]])

    def tangent(self, moments: Float) -> float:
        """Tangent of the tilt angle of a body with moments (4,), as in ``constraints``."""
        share = 1.0 if self.share is None else self.share
        return float(np.min(self.constraints(0.0) @ moments / share) / moments[3])
