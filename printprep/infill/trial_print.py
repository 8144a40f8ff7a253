"""Weighs a trial print: the part is sliced with the real slicer, and its G-code is measured."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from printprep.files import scratch_folder
from printprep.output.item import infill_item

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.profiles import Profile
    from printprep.slicer.process import Slicer
    from printprep.types import Part, Stability


@dataclass(frozen=True, eq=False)
class Weighed:
    """What a print deposits and how it stands, for each solid that stands by itself.

    moments : (k, 4) volume in mm³ and first moments x, y, z in mm⁴, in the part's coordinates.
    stabilities : one for each of the k solids.
    """

    moments: Float
    stabilities: tuple[Stability, ...]


class TrialSlicer:
    """Slices parts with one profile, and each file only once."""

    def __init__(self, slicer: Slicer, profile: Profile) -> None:
        self.slicer = slicer
        self.profile = profile
        self._known: dict[bytes, Weighed] = {}

    @property
    def slices(self) -> int:
        """How often the slicer ran."""
        return len(self._known)

    def weigh(self, part: Part, ballast: Sequence[Manifold], apart: Sequence[Manifold]) -> Weighed:
        """Slice a part and measure it.

        apart : the solids that stand by themselves; beads of a base go to the nearest one.

        Raises ToolError if the slicer refuses the part, or its print cannot be measured.
        """
        from printprep.threemf.write import write_3mf

        item = infill_item(part.manifold, ballast, part.name, self.profile)
        content = write_3mf([item])
        if content not in self._known:
            at_mm = np.array(item.translation_mm)
            self._known[content] = self._measured(content, at_mm, apart)
        return self._known[content]

    def _measured(self, content: bytes, at_mm: Float, apart: Sequence[Manifold]) -> Weighed:
        """Slice a 3MF and measure it.  at_mm : (3,) place of the part's origin on the bed."""
        from printprep.gcode.measure import measure_sliced
        from printprep.gcode.stability import stability_of_print
        from printprep.slicer.prusa_ini import profile_settings

        with scratch_folder() as folder:
            file, gcode = folder / "part.3mf", folder / "part.gcode"
            file.write_bytes(content)
            self.slicer.slice(file, gcode, profile_settings(self.profile))
            bodies = [solid.translate(at_mm.tolist()) for solid in apart]
            printed = measure_sliced(gcode, self.slicer.name, bodies=bodies)
        mm3 = printed.volume_mm3 / printed.mass_g
        moments, stabilities = [], []
        for body in printed.bodies or (printed,):
            on_bed = stability_of_print(body)
            centre = np.array(on_bed.centre_of_mass_mm) - at_mm
            moments.append(body.mass_g * mm3 * np.array([1.0, *centre]))
            x, y, z = centre.tolist()
            stabilities.append(
                replace(
                    on_bed,
                    support_polygon_mm=on_bed.support_polygon_mm - at_mm[:2],
                    centre_of_mass_mm=(x, y, z + float(at_mm[2])),
                )
            )
        return Weighed(np.stack(moments), tuple(stabilities))
