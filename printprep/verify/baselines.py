"""What the model takes when it is printed the usual ways, with walls as thick as the part's.

With the least lines and layers that are no thinner than the profile's wall: solid but for 15 %
gyroid, and with lightning infill, which only holds up ceilings.
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

    from printprep.slicer.process import Slicer
    from printprep.verify.part_3mf import ComputedPart

_BASELINES = (
    ("15 % gyroid", {"fill_density": "15%", "fill_pattern": "gyroid"}),
    ("lightning infill", {"fill_density": "15%", "fill_pattern": "lightning"}),
)
_SLACK_MM = 1.0  # between the model's size and the part's, beyond the base


@dataclass(frozen=True)
class Baseline:
    """A usual way to print: its mass, its tilt angle, and its seconds by the slicer's estimate."""

    name: str
    mass_g: float
    seconds: float | None
    tilt_deg: float


def model_of(part: ComputedPart, model: Path) -> Manifold:
    """The model the part was made of, as a solid where the part is.

    Raises UsageError where it is another model, else what reading and repairing it raise.
    """
    from printprep.mesh.read import read_mesh
    from printprep.mesh.repair import repair
    from printprep.types import Model

    raw = read_mesh(model)
    # Mesh readers may have turned and scaled the file's numbers; the placement starts from those
    from_raw = part.placement @ np.linalg.inv(raw.from_file)
    vertices = raw.vertices @ from_raw[:3, :3].T + from_raw[:3, 3]
    _refuse_another(part, model, vertices.max(axis=0) - vertices.min(axis=0))
    return repair(Model(vertices, raw.faces, from_raw, raw.name)).manifold


def slice_baselines(
    program: Slicer,
    part: ComputedPart,
    model: Manifold,
    settings: Mapping[str, str],
    load: Path | None,
    folder: Path,
) -> tuple[Baseline, ...]:
    """Slice the model as it is, placed as the part is, once for each usual way.

    Raises ToolError where the slicer fails.
    """
    from printprep.gcode.measure import measure_gcode
    from printprep.gcode.stability import tilt_as_printed
    from printprep.mesh.write import to_bytes
    from printprep.output.prusa_keys import wall_keys

    stl = folder / "model.stl"
    stl.write_bytes(to_bytes(model, ".stl"))
    gcode = folder / "other.gcode"
    baselines = []
    for name, infill in _BASELINES:
        program.slice(stl, gcode, {**settings, **wall_keys(part.profile), **infill}, load)
        printed = measure_gcode(gcode)
        tilt = tilt_as_printed(printed, part.lean)
        baselines.append(Baseline(name, printed.mass_g, printed.slicer_summary.seconds, tilt))
    return tuple(baselines)


def _refuse_another(part: ComputedPart, model: Path, size_mm: np.ndarray) -> None:
    growth_mm = 2 * part.profile.stability.base_growth_max_mm
    base_mm = np.array([growth_mm, growth_mm, 0.0])  # grows the footprint only
    room = part.size_mm - size_mm
    if (room < -_SLACK_MM).any() or (room > base_mm + _SLACK_MM).any():
        sizes = " × ".join(f"{side:.1f}" for side in size_mm)
        raise UsageError(
            f"{model.name} is not the model that {part.file.name} was made of: placed alike it is "
            f"{sizes} mm.",
            "Name that model's file, unchanged.",
        )
