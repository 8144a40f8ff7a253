"""The model printed with usual infills, and with walls as thick as the part's.

The walls have the least number of lines and layers that are no thinner than the profile's wall.
The infills are 15 % gyroid, and lightning, which only holds up ceilings.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import UsageError

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.arrays import Float
    from printprep.slicer.process import Slicer
    from printprep.verify.part_3mf import ComputedPart

_BASELINES = (
    ("15 % gyroid", {"fill_density": "15%", "fill_pattern": "gyroid"}),
    ("lightning infill", {"fill_density": "15%", "fill_pattern": "lightning"}),
)
_SLACK_MM = 1.0  # by which the sizes of model and part may differ, besides the base


@dataclass(frozen=True)
class Baseline:
    """The model with a usual infill.  seconds : the slicer's estimate of the printing time."""

    name: str
    mass_g: float
    seconds: float | None
    tilt_deg: float


def model_of(part: ComputedPart, model: Path) -> Manifold:
    """The model that the part was made from, as a solid in the part's place.

    Raises UsageError if it is another model, and whatever reading and repairing it raise.
    """
    from printprep.mesh.read import read_mesh
    from printprep.mesh.repair import repair
    from printprep.types import Model

    raw = read_mesh(model)
    # A mesh reader may have turned and scaled the file's numbers; the placement starts from those.
    from_raw = part.placement @ np.linalg.inv(raw.from_file)
    vertices = raw.vertices @ from_raw[:3, :3].T + from_raw[:3, 3]
    _refuse_another_model(part, model, vertices.max(axis=0) - vertices.min(axis=0))
    return repair(Model(vertices, raw.faces, from_raw, raw.name)).manifold


def slice_baselines(
    program: Slicer,
    part: ComputedPart,
    model: Manifold,
    settings: Mapping[str, str],
    load: Path | None,
    folder: Path,
) -> tuple[Baseline, ...]:
    """Slice the model in the part's place, once with each usual infill.

    Raises ToolError if the slicer fails.
    """
    from printprep.gcode.measure import measure_sliced
    from printprep.gcode.stability import tilt_as_printed
    from printprep.mesh.write import to_bytes
    from printprep.output.prusa_keys import wall_keys, without_columns

    stl = folder / "model.stl"
    stl.write_bytes(to_bytes(model, ".stl"))
    gcode = folder / "baseline.gcode"
    baselines = []
    settings = without_columns(settings)
    for name, infill in _BASELINES:
        program.slice(stl, gcode, {**settings, **wall_keys(part.profile), **infill}, load)
        printed = measure_sliced(gcode, program.name)
        tilt = tilt_as_printed(printed, part.lean)
        baselines.append(Baseline(name, printed.mass_g, printed.slicer_summary.seconds, tilt))
    return tuple(baselines)


def _refuse_another_model(part: ComputedPart, model: Path, size_mm: Float) -> None:
    """Raise UsageError if a model of this size, (3,) mm, cannot be the part's model."""
    growth_mm = 2 * part.profile.stability.base_growth_max_mm
    base_mm = np.array([growth_mm, growth_mm, 0.0])  # a base grows only the footprint
    larger_mm = part.size_mm - size_mm
    if (larger_mm < -_SLACK_MM).any() or (larger_mm > base_mm + _SLACK_MM).any():
        sizes = " × ".join(f"{side:.1f}" for side in size_mm)
        part_sizes = " × ".join(f"{side:.1f}" for side in part.size_mm)
        raise UsageError(
            f"{model.name} is not the model that {part.file.name} was made from: in its place it "
            f"measures {sizes} mm, the part {part_sizes} mm.",
            "Name the file of that model, unchanged.",
        )
