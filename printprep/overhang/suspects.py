"""Where alone a void can have what the acceptance rule flags: shallow faces, keels, tips, grooves.

Notation: s the tangent of a face's overhang, u the unit vector in which it faces, seen from above;
T = off / h and t = (off − c) / h (limits.py).  A way down falls |Δxy| ≤ T |Δz|.

What is flagged is either material of the layer above or void that closing fills.

Material.  From a point of the ceiling follow ways down on the surface.  A face with s ≤ T has one,
its line of steepest descent, until it ends at an edge.  Either a face beyond goes on down, or both
faces fall toward the edge, a keel of material that hangs in the void, and the edge itself must be
a way down; a corner has one where an edge or a face that meets there does.  Where that never fails
there is material a layer deeper within h T = off.  Hence flagged material lies within off of a
*shallow* face, s > T, of a *keel* that is no way down, or of a *tip* without any.

Void.  Closing fills a point p where no disc of radius c in the void reaches it: between walls A and
B, on the arc of a disc no larger that touches both, at distances of them with
δ_A + δ_B ≤ c (1 − u_A·u_B).  Where it is held by three walls instead, two of them face each other
by 120° or more, and the sum is at most 2c.  It is flagged only where there is no material a layer
deeper within off of it, δ + h s > off for both; so only where

    h (s_A + s_B) > 2 off − c min(2, (1 − u_A·u_B) 4/3),

one of them with s > t.  Two such walls close above p, within c / t, in an edge or a corner where
both meet: a *groove*.

That leaves out a throat, where the rim of one wall comes within 2c of the other and the gap widens
again above: no edge joins them.  What is missed there is a strip narrower than c.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import arrays
from printprep.overhang.grooves import groove_depth_mm, grooves
from printprep.overhang.surface import Surface

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.overhang.limits import Acceptance

# Of off: slices are simplified, coordinates rounded, and polygons stand for round funnels.
SLACK_MM = 0.005


@dataclass(frozen=True, eq=False)
class Suspects:
    """low_mm, high_mm : (n, 3) boxes around the faces, edges and corners in question."""

    low_mm: Float
    high_mm: Float

    def __len__(self) -> int:
        return len(self.low_mm)

    @staticmethod
    def of(void: Manifold, rule: Acceptance) -> Suspects:
        """All of a void's surface."""
        vertices, faces = arrays(void)
        if len(faces) == 0:
            return Suspects(np.zeros((0, 3)), np.zeros((0, 3)))
        surface = Surface.of(vertices, faces, (rule.off_mm - SLACK_MM) / rule.layer_mm)
        closing = surface.vertices[grooves(surface, rule)]
        # What a groove closes lies below it.
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
        """Those that meet any of the boxes (k, 3)."""
        met = np.zeros(len(self), dtype=bool)
        for low, high in zip(low_mm, high_mm, strict=True):
            met |= ((self.low_mm <= high) & (self.high_mm >= low)).all(axis=1)
        return Suspects(self.low_mm[met], self.high_mm[met])
