"""Computes the tilt angle: how far a part can lean before it tips."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from printprep.mesh.measure import bodies, volume_and_centre
from printprep.stand.contact import Contact, contact_of, section_at_bed
from printprep.types import Stability

if TYPE_CHECKING:
    from manifold3d import Manifold


def stability(manifold: Manifold, first_layer_mm: float) -> Stability:
    """The stability of a part; of several bodies that do not touch, the weakest one counts.

    The tilt angle over edge k is atan((d_k − n_k · c_xy) / c_z), with the edge's outward normal
    n_k and offset d_k, the centre of mass c, and the pivot at z = 0; the least of them counts.

    Parameters
    ----------
    manifold : the part, on the bed, with its cavities.
    first_layer_mm : height of the first layer; contact is the section at half of it.
    """
    return least_stable(_one_body(body, first_layer_mm) for body in bodies(manifold))


def balanced(contact: Contact | None, centre_mm: tuple[float, float, float]) -> Stability:
    """The stability of a body with this contact (None: no contact) and centre of mass."""
    if contact is None:
        return Stability(np.zeros((0, 2)), 0.0, centre_mm, None, None, None)
    footing = contact.footing
    ahead = footing.offsets_mm - footing.normals @ np.array(centre_mm[:2])
    weakest = int(np.argmin(ahead))
    nx, ny = footing.normals[weakest]
    return Stability(
        support_polygon_mm=contact.polygon_mm,
        contact_area_mm2=contact.area_mm2,
        centre_of_mass_mm=centre_mm,
        tilt_deg=float(np.degrees(np.arctan2(ahead[weakest], centre_mm[2]))),
        weakest_edge=weakest,
        weakest_azimuth_deg=float(np.degrees(np.arctan2(ny, nx)) % 360.0),
    )


def least_stable(each: Iterable[Stability]) -> Stability:
    """The one that tips first; one without contact before all others."""
    return min(each, key=lambda found: -np.inf if found.tilt_deg is None else found.tilt_deg)


def _one_body(body: Manifold, first_layer_mm: float) -> Stability:
    contact = contact_of(section_at_bed(body, first_layer_mm))
    return balanced(contact, volume_and_centre(body)[1])
