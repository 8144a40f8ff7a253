"""How each slicer names the settings that a profile takes, and what its percentages are of.

Facts from the programs' public source: ``Flow.cpp`` and ``PrintConfig.cpp`` of PrusaSlicer 2.5 to
2.9, SuperSlicer 2.5 and OrcaSlicer 2.3.  There a line width of 0 is 1.125 times the nozzle for
walls (``auto_extrusion_width``).  A first layer in percent is found in older files of PrusaSlicer;
its present versions slice none.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

AUTO_WIDTH = 1.125


@dataclass(frozen=True)
class Dialect:
    """The names of settings in one slicer.

    line_widths : the first of them that is set and not 0 counts.  That of the outer wall comes
        first: the slicer judges overhangs by it.
    percent_of : what a percentage of a line width and of the first layer is of.
    """

    program: str
    layer_height: str
    first_layer: str
    line_widths: tuple[str, ...]
    percent_of: Literal["layer", "nozzle"]
    bed_shape: str
    height: str
    nozzle: str = "nozzle_diameter"
    material: str = "filament_type"
    density: str = "filament_density"
    filament: str = "filament_diameter"

    @property
    def names(self) -> tuple[str, ...]:
        """All settings that a profile takes."""
        return (
            self.layer_height,
            self.first_layer,
            *self.line_widths,
            self.nozzle,
            self.bed_shape,
            self.height,
            self.material,
            self.density,
            self.filament,
        )


PRUSA = Dialect(
    program="PrusaSlicer",
    layer_height="layer_height",
    first_layer="first_layer_height",
    line_widths=("external_perimeter_extrusion_width", "extrusion_width"),
    percent_of="layer",
    bed_shape="bed_shape",
    height="max_print_height",
)
SUPER = Dialect(
    program="SuperSlicer",
    layer_height="layer_height",
    first_layer="first_layer_height",
    line_widths=("external_perimeter_extrusion_width", "extrusion_width"),
    percent_of="nozzle",
    bed_shape="bed_shape",
    height="max_print_height",
)
ORCA = Dialect(
    program="OrcaSlicer or Bambu Studio",
    layer_height="layer_height",
    first_layer="initial_layer_print_height",
    line_widths=("outer_wall_line_width", "line_width"),
    percent_of="nozzle",
    bed_shape="printable_area",
    height="printable_height",
)
