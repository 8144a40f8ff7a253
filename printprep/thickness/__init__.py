"""How thick material is at every place of a surface, and how wide the gaps outside it are."""

from printprep.thickness.local import LocalThickness, local_thickness
from printprep.thickness.thin import Thin, gap_places, thin_places

__all__ = ["LocalThickness", "Thin", "gap_places", "local_thickness", "thin_places"]
