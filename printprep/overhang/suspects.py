"""Finds where alone the overhang rule can flag a void: shallow faces, keels, tips, grooves.

Notation: s the tangent of a face's overhang, u the unit vector in which it faces, seen from above;
T = off / h and t = (off − c) / h (limits.py).  A *way down* is a path on the surface that falls
with |Δxy| ≤ T |Δz|.

The rule flags either material of the layer above or void that closing fills.

Material.  From a point of the ceiling, follow ways down on the surface.  A face with s ≤ T has one,
its line of steepest descent, until it ends at an edge.  There either the next face continues
downward, or both faces fall toward the edge, which is a keel of material that hangs in the void;
then the edge itself must be a way down.  A corner has a way down where an edge or a face that meets
there has one.  Where none of this fails, there is material one layer deeper within h T = off.
Hence flagged material lies within off of a *shallow* face, s > T, of a *keel* too flat to be a way
down, or of a *tip*, a corner without a way down.

Void.  Closing fills a point p that no disc of radius c in the void reaches: between walls A and
B, on the arc of a disc no larger that touches both, at distances of them with
δ_A + δ_B ≤ c (1 − u_A·u_B).  Where three walls hold the disc instead, two of them face each other
by 120° or more, and the sum is at most 2c.  The point is flagged only where no material lies one
layer deeper within off of it, δ + h s > off for both; so only where

    h (s_A + s_B) > 2 off − c min(2, (1 − u_A·u_B) 4/3),

one of them with s > t.  Two such walls close above p, within c / t, in an edge or a corner where
both meet: a *groove*.

This misses a throat, where the rim of one wall comes within 2c of the other and the gap widens
again above: no edge joins them.  The strip missed there is narrower than c.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.overhang.grooves import groove_depth_mm, grooves
from printprep.overhang.surface import VoidSurface

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.overhang.limits import Acceptance

# Reserve in off: slices are simplified, coordinates rounded, and funnels have polygons as sections.
SLACK_MM = 0.005


@dataclass(frozen=True, eq=False)
class Suspects:
    """Boxes around the faces, edges and corners where the rule can flag something.

    low_mm, high_mm : (n, 3).
    """

    low_mm: Float
    high_mm: Float

    def __len__(self) -> int:
        return len(self.low_mm)

    @staticmethod
    def of(void: Manifold, rule: Acceptance) -> Suspects:
        """All suspects on the surface of a void."""
        vertices, faces = arrays(void)
        if len(faces) == 0:
            return Suspects(np.zeros((0, 3)), np.zeros((0, 3)))
        surface = VoidSurface.of(vertices, faces, (rule.off_mm - SLACK_MM) / rule.layer_mm)
        closing = surface.vertices[grooves(surface, rule)]
        # The void that a groove closes lies below it.
        closing = np.concatenate([closing, closing - [0.0, 0.0, groove_depth_mm(rule)]], axis=1)
        boxes = [
            vertices[faces[surface.shallow]],
            vertices[surface.steep_keels()],
            vertices[surface.tips()][:, None],
            closing,
        ]
        return Suspects(
            np.concatenate([box.min(axis=1) for box in boxes]),
            np.concatenate([box.max(axis=1) for box in boxes]),
        )

    def near(self, low_mm: Float, high_mm: Float) -> Suspects:
        """Those that meet any of some boxes; low_mm, high_mm : (k, 3)."""
        met = np.zeros(len(self), dtype=bool)
        for low, high in zip(low_mm, high_mm, strict=True):
            met |= ((self.low_mm <= high) & (self.high_mm >= low)).all(axis=1)
        return Suspects(self.low_mm[met], self.high_mm[met])
