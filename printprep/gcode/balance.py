"""Balance of a print, from its moments and the beads of its lowest layer."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from printprep.gcode.first_layer import contact_of_beads
from printprep.gcode.printed import Balance

if TYPE_CHECKING:
    from printprep.arrays import Float


def balance_of(moments: Float, beads: Float, bed_mm: float) -> Balance:
    """How a print stands on the bed.

    moments : (10,) as in :mod:`printprep.gcode.moments`, in g, g·mm and g·mm²;  beads : (n, 7) that
    touch the bed, as ``LowestBeads``, n = 0 for none;  bed_mm : height of the bed in the machine.
    """
    x, y, z = (float(value) for value in moments[1:4] / moments[0])
    centre = (x, y, z - bed_mm)
    contact = contact_of_beads(beads)
    if contact is None:
        return Balance(float(moments[0]), centre, np.zeros((0, 2)), 0.0, None)
    ahead = contact.footing.offsets_mm - contact.footing.normals @ np.array(centre[:2])
    tilt = float(np.degrees(np.arctan2(ahead.min(), centre[2])))
    return Balance(float(moments[0]), centre, contact.polygon_mm, contact.area_mm2, tilt)
