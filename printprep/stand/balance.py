"""Where a part's weight and feet are, as JSON: what a print of it can be compared with."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from printprep.mesh.measure import bodies, mass_properties
from printprep.stand.contact import contact_of, section_at_bed

if TYPE_CHECKING:
    from collections.abc import Sequence

    from manifold3d import Manifold


def balance_json(
    part: Manifold, first_layer_mm: float, centre_mm: Sequence[float] | None = None
) -> dict[str, Any]:
    """Of the whole part, in its own coordinates (on the bed, z up).

    centre_mm : the centre of mass of a part that is not solid throughout.

    bounds_mm, centre_of_mass_mm;  contact : hull (counter-clockwise) and area of the first layer's
    section, null without one;  bodies : how many parts do not touch each other.
    """
    contact = contact_of(section_at_bed(part, first_layer_mm))
    return {
        "bounds_mm": [_place(corner) for corner in np.reshape(part.bounding_box(), (2, 3))],
        "centre_of_mass_mm": _place(
            mass_properties(part).centre_mm if centre_mm is None else centre_mm
        ),
        "contact": None
        if contact is None
        else {
            "polygon_mm": [_place(corner) for corner in contact.polygon_mm],
            "area_mm2": float(f"{contact.area_mm2:.6g}"),
        },
        "bodies": len(bodies(part)),
    }


def _place(point: Sequence[float]) -> list[float]:
    return [round(float(value), 4) + 0.0 for value in point]
