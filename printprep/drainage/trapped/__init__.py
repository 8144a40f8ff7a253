"""What stays inside a part that should run out of it, and where it sucks while it prints."""

from printprep.drainage.trapped.cups import Cup, suction_cups
from printprep.drainage.trapped.pockets import Pocket, trapped

__all__ = ["Cup", "Pocket", "suction_cups", "trapped"]
