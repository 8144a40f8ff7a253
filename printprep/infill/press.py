"""A print to be weighed: the part goes through the real slicer, and its G-code is measured."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.infill.item import item_of, middle_of_bed

if TYPE_CHECKING:
    from manifold3d import Manifold
    from numpy.typing import NDArray

    from printprep.profiles import Profile
    from printprep.slicer.process import Slicer
    from printprep.types import Part, Stability

    Float = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Weighed:
    """What a print deposits, (4,) mm³ and mm⁴, and how it stands; in the part's coordinates."""

    moments: Float
    standing: Stability

    @property
    def centre_mm(self) -> tuple[float, float, float]:
        """The centre of mass, heights from the bed."""
        return self.standing.centre_of_mass_mm


class Press:
    """Slices parts with one profile, the same file once only."""

    def __init__(self, slicer: Slicer, profile: Profile) -> None:
        self.slicer = slicer
        self.profile = profile
        self._known: dict[bytes, Weighed] = {}

    @property
    def slices(self) -> int:
        """How often the slicer was asked."""
        return len(self._known)

    def weigh(self, part: Part, ballast: Sequence[Manifold]) -> Weighed:
        """Slice a part and measure it.

        Raises ToolError where the slicer refuses it, InputError where it has no first layer.
        """
        from printprep.threemf.write import write_3mf

        item = item_of(part.manifold, ballast, part.name, self.profile)
        content = write_3mf([item])
        if content not in self._known:
            self._known[content] = self._measured(content, bottom_mm=-item.translation_mm[2])
        return self._known[content]

    def _measured(self, content: bytes, bottom_mm: float) -> Weighed:
        from printprep.gcode.measure import measure_gcode
        from printprep.slicer.export import profile_settings
        from printprep.slicer.verify_rules import standing

        with tempfile.TemporaryDirectory(prefix="printprep-") as name:
            file, gcode = Path(name) / "part.3mf", Path(name) / "part.gcode"
            file.write_bytes(content)
            self.slicer.slice(file, gcode, profile_settings(self.profile))
            printed = measure_gcode(gcode)
        stands = standing(printed)
        middle = middle_of_bed(self.profile)
        x, y, z = printed.centre_of_mass_mm
        x, y = x - middle[0], y - middle[1]
        return Weighed(
            printed.volume_mm3 * np.array([1.0, x, y, z + bottom_mm]),
            replace(
                stands,
                support_polygon_mm=stands.support_polygon_mm - middle,
                centre_of_mass_mm=(x, y, z),
            ),
        )
