"""Writes a part's balance (centre of mass, contact) as JSON, to compare a print of it with."""

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
    """The balance of a part, in its coordinates (on the bed, z up).

    centre_mm : (3,) centre of mass of a part that is not solid throughout (sparse infill).

    Keys: bounds_mm, centre_of_mass_mm;  contact : hull (counter-clockwise) and area of the first
    layer's section, null where it is empty;  bodies : number of bodies that do not touch.
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
