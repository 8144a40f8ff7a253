"""Trapped liquid and powder, and suction cups: what should run out of a part and does not."""

from printprep.drainage.trapped.clearance import Clearance
from printprep.drainage.trapped.cups import Cup, suction_cups
from printprep.drainage.trapped.openings import Chamber, chambers
from printprep.drainage.trapped.pockets import Pocket, pour_clearance, trapped

__all__ = [
    "Chamber",
    "Clearance",
    "Cup",
    "Pocket",
    "chambers",
    "pour_clearance",
    "suction_cups",
    "trapped",
]
