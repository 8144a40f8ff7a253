"""The tilt angle toward one azimuth (``stability`` gives the least over all azimuths)."""

from __future__ import annotations

import numpy as np

from printprep.stand.contact import Contact
from printprep.types import Stability


def directional_tilt_deg(standing: Stability, azimuth_deg: float) -> float | None:
    """The lean toward one azimuth at which the line of the weight leaves the support polygon.

    When the part leans by α toward the horizontal unit vector u, the vertical through its centre of
    mass c meets the bed at c_xy + c_z tan α · u.  It crosses edge k, with outward normal n_k and
    offset d_k, at tan α = (d_k − n_k · c_xy) / (c_z n_k · u); the first edge ahead counts.

    Parameters
    ----------
    azimuth_deg : direction of u, from +x counter-clockwise.

    Returns
    -------
    Degrees, at least ``standing.tilt_deg``, and equal to it toward the weakest edge; the negative
    ``standing.tilt_deg`` for a part that falls even upright; None without contact.
    """
    if standing.tilt_deg is None or standing.tilt_deg < 0:
        return standing.tilt_deg
    footing = Contact(standing.support_polygon_mm, standing.contact_area_mm2).footing
    centre = np.array(standing.centre_of_mass_mm)
    azimuth = np.radians(azimuth_deg)
    toward = footing.normals @ np.array([np.cos(azimuth), np.sin(azimuth)])
    inside = footing.offsets_mm - footing.normals @ centre[:2]
    ahead = toward > 0
    return float(np.degrees(np.arctan(np.min(inside[ahead] / toward[ahead]) / centre[2])))
