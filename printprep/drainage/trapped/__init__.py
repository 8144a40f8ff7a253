"""Trapped liquid and powder, and suction cups: what should run out of a part and does not."""

from printprep.drainage.trapped.cups import Cup, suction_cups
from printprep.drainage.trapped.pockets import Pocket, trapped

__all__ = ["Cup", "Pocket", "suction_cups", "trapped"]
