"""What standing costs: the least mass for every lean, beside what one would print otherwise."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.density.program import BasePolicy, Choice
    from printprep.profiles import Profile
    from printprep.types import Part

MOST_DEG = 60.0


@dataclass(frozen=True)
class Point:
    """The lightest filling that stands at a lean, at voxel resolution.

    growth_mm : of the base's footprint, None without a base;  gap : of the certificate, relative.
    """

    lean_deg: float
    mass_g: float
    growth_mm: float | None
    gap: float


@dataclass(frozen=True)
class Mark:
    """Something to compare with: what it weighs, and the lean at which it tips, None: at once."""

    name: str
    mass_g: float
    tilt_deg: float | None


@dataclass(frozen=True, eq=False)
class Exploration:
    """The curve, its end (the largest lean any filling and base reaches), and the marks."""

    name: str
    profile: Profile
    points: tuple[Point, ...]
    reachable_deg: float
    marks: tuple[Mark, ...]


def explore(
    model: str | Path,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    units: str | None = None,
    up: str = "+z",
    scale: float | None = None,
    height_mm: float | None = None,
    size_mm: float | None = None,
    resolution: int = 64,
    base: BasePolicy = "auto",
    self_support: bool | None = None,
    count: int = 13,
    progress: Progress = SILENT,
) -> Exploration:
    """The Pareto curve of mass against lean, each point optimal and proven.

    Parameters are those of :func:`printprep.hollow`; ``count`` leans are solved, evenly from 0° to
    the largest that any filling on any base reaches (at most 60°).

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.cavity.surface import cavity_surface
    from printprep.density.outcome import paper_density
    from printprep.density.program import Program
    from printprep.errors import UsageError
    from printprep.grid.depth import measure_depths
    from printprep.grid.domain import weigh_interior
    from printprep.mesh.repair import repair
    from printprep.pipeline.cavity import carve
    from printprep.pipeline.hollow import placed_model
    from printprep.profiles import load_profile
    from printprep.stand.stability import stability
    from printprep.supports.policy import supported, supports_wanted
    from printprep.types import Lean

    if not 2 <= count <= 200:
        raise UsageError(f"A curve of {count} points is not between 2 and 200.")
    settings = load_profile(profile, {**(overrides or {}), "stability.lean_margin_deg": 0.0})
    carried = supports_wanted(self_support, settings)
    with progress.stage("read"):
        placed = placed_model(model, units, up, scale, height_mm, size_mm)
    with progress.stage("repair"):
        solid = repair(placed)
    with progress.stage("voxelize"):
        depths = measure_depths(
            solid,
            resolution=resolution,
            wall_mm=settings.wall_mm,
            min_feature_mm=settings.min_feature_mm,
            margin_mm=settings.stability.base_growth_max_mm,
        )
    grams = settings.material.density_g_cm3 / 1000
    first_layer = settings.printer.first_layer_mm
    with progress.stage("cavity"):
        hollowable_volume = cavity_surface(solid.manifold, depths.field, settings.wall_mm)
    if carried and not hollowable_volume.is_empty():
        with progress.stage("supports"):
            hollowable_volume, _ = supported(hollowable_volume, settings)
    program = Program(solid.manifold, weigh_interior(solid, depths, hollowable_volume), settings)
    with progress.stage("solve"):
        farthest = program.choose(base, Lean(MOST_DEG))
        reachable = min(farthest.reached, MOST_DEG)
        leans = np.linspace(0.0, reachable, count) if reachable > 0 else np.zeros(0)
        points = tuple(
            _point(float(lean), program.choose(base, Lean(float(lean))), grams) for lean in leans
        )

    def mark(name: str, part: Part) -> Mark:
        standing = stability(part.manifold, first_layer)
        return Mark(name, part.manifold.volume() * grams, standing.tilt_deg)

    with progress.stage("cavity"):
        empty = (None,) * len(program.bodies)
        # The paper's B is a base too: its objective is given the one that the profile's lean takes.
        footed = program.choose(base, Lean(settings.stability.lean_deg))
        planes = paper_density(program, footed).planes
        marks = (
            Mark(
                "solid",
                solid.manifold.volume() * grams,
                stability(solid.manifold, first_layer).tilt_deg,
            ),
            mark(
                "shell alone",
                carve(solid, None, hollowable_volume, settings, program.bodies, empty),
            ),
            mark(
                "paper's objective",
                carve(solid, footed.base, hollowable_volume, settings, program.bodies, planes),
            ),
        )
    return Exploration(solid.name, settings, points, reachable, marks)


def _point(lean_deg: float, choice: Choice, grams: float) -> Point:
    return Point(
        lean_deg=lean_deg,
        mass_g=choice.volume_mm3 * grams,
        growth_mm=None if choice.base is None else choice.base.growth_mm,
        gap=(choice.volume_mm3 - choice.bound_mm3) / choice.volume_mm3,
    )
