"""Contact of a part with the bed: the section that the slicer prints as the first layer.

Contact is the section at half the first layer's height, where a slicer cuts that layer.  The part
tips on the bed, z = 0, about the edges of the section's convex hull, its support polygon.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.stand.footing import Footing

if TYPE_CHECKING:
    from manifold3d import CrossSection, Manifold
    from numpy.typing import NDArray

# A smaller contact cannot be printed: the square of 0.1 mm.
LEAST_CONTACT_MM2 = 0.01


@dataclass(frozen=True, eq=False)
class Contact:
    """The contact of one body with the bed.

    polygon_mm : (k, 2) convex hull, counter-clockwise;  area_mm2 : of the section, not the hull.
    """

    polygon_mm: NDArray[np.float64]
    area_mm2: float

    @property
    def footing(self) -> Footing:
        """The hull's edges as outward normals and offsets; edge i runs from vertex i to i + 1."""
        return Footing.around(self.polygon_mm)


def section_at_bed(manifold: Manifold, first_layer_mm: float) -> CrossSection:
    """The section that a slicer prints as the first layer."""
    return manifold.slice(first_layer_mm / 2)


def contact_of(section: CrossSection) -> Contact | None:
    """The contact of a first-layer section, None where it is too small to print."""
    area = float(section.area())
    if area < LEAST_CONTACT_MM2:
        return None
    polygon = np.asarray(section.hull().to_polygons()[0], dtype=float)
    along = np.roll(polygon, -1, axis=0) - polygon
    # Edges shorter than a nanometre have no reliable direction.
    return Contact(polygon[np.linalg.norm(along, axis=1) > 1e-6], area)
