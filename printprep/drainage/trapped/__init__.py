"""Trapped liquid and powder, and suction cups: what should run out of a part and does not."""

from printprep.drainage.trapped.cups import Cup, suction_cups
from printprep.drainage.trapped.openings import Chamber, chambers
from printprep.drainage.trapped.pockets import Pocket, trapped

__all__ = ["Chamber", "Cup", "Pocket", "chambers", "suction_cups", "trapped"]
