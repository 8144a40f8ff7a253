"""The edges of a support polygon as linear constraints on mass and first moments."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Footing:
    """What a balance must know of the ground: (k, 2) outward unit normals and (k,) offsets, mm.

    An edge's line is {x : normal · x = offset}; the body's foot lies on the inner side.
    """

    normals: Float
    offsets_mm: Float

    def constraints(self, lean_deg: float) -> Float:
        """(k, 4) rows H with H s ≥ 0 exactly when s stands at the lean."""
        tangent = np.full((len(self.offsets_mm), 1), np.tan(np.radians(lean_deg)))
        return np.hstack([self.offsets_mm[:, None], -self.normals, -tangent])

    def tangent(self, moments: Float) -> float:
        """Tangent of the tilt angle of a body with moments (4,): of the lean at which it tips."""
        return float(np.min(self.constraints(0.0) @ moments) / moments[3])
