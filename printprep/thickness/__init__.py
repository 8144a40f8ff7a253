"""Thickness of the material at every place of a surface, and width of the gaps outside it."""

from printprep.thickness.local import LocalThickness, local_thickness
from printprep.thickness.thin import Thin, gap_places, thin_places

__all__ = ["LocalThickness", "Thin", "gap_places", "local_thickness", "thin_places"]
