"""The least mass for every lean, and the usual parts to compare it with."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import UsageError
from printprep.pipeline.options import AS_IN_FILE, FillOptions, Placement, check_resolution
from printprep.progress import SILENT, Progress
from printprep.supports.policy import vault_choice

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.density.program import Choice
    from printprep.profiles import Profile

MOST_DEG = 60.0
DEFAULT = FillOptions()


@dataclass(frozen=True)
class Point:
    """The lightest filling that stands at a lean, at voxel resolution.

    growth_mm : how far the base grows the footprint, None without a base.
    gap : the relative gap of its certificate.
    """

    lean_deg: float
    mass_g: float
    growth_mm: float | None
    gap: float


@dataclass(frozen=True)
class Mark:
    """A part to compare with: its mass, and its tilt angle, None if it does not touch the bed."""

    name: str
    mass_g: float
    tilt_deg: float | None


@dataclass(frozen=True, eq=False)
class Exploration:
    """The curve, the largest lean that any filling on any base reaches, and the marks."""

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
    placement: Placement = AS_IN_FILE,
    options: FillOptions = DEFAULT,
    count: int = 13,
    progress: Progress = SILENT,
) -> Exploration:
    """The Pareto curve of mass against lean; each point is a proven optimum.

    Parameters are those of :func:`printprep.hollow`; of the options only resolution, base and
    vaults count.  ``count`` leans are solved, evenly spaced from 0° to the largest that any
    filling on any base reaches (at most 60°).

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.cavity.carve import finished
    from printprep.paper.on_solid import paper_density
    from printprep.pipeline.cavity import carve
    from printprep.pipeline.hollowable import hollowable
    from printprep.pipeline.prepare import prepare
    from printprep.pipeline.voids import settle_voids
    from printprep.profiles import load_profile
    from printprep.stand.stability import stability
    from printprep.types import Lean

    if not 2 <= count <= 200:
        raise UsageError(f"--points {count} is not between 2 and 200.", "The default is 13.")
    check_resolution(options.resolution)
    settings = load_profile(profile, {**(overrides or {}), "stability.lean_margin_deg": 0.0})
    vault_choice(options.vaults, settings)
    prepared = settle_voids(prepare(model, settings, placement, progress), options, progress)
    solid = prepared.solid
    grams = settings.material.density_g_cm3 / 1000
    first_layer_mm = settings.printer.first_layer_mm
    volume = hollowable(prepared, options, progress)
    program = volume.program(solid)
    with progress.stage("solve"):
        farthest = program.choose(options.base, Lean(MOST_DEG))
        reachable = min(farthest.reached, MOST_DEG)
        leans = np.linspace(0.0, reachable, count) if reachable > 0 else np.zeros(0)
        points = tuple(
            _point(float(lean), program.choose(options.base, Lean(float(lean))), grams)
            for lean in leans
        )

    def mark(name: str, part: Manifold) -> Mark:
        return Mark(name, part.volume() * grams, stability(part, first_layer_mm).tilt_deg)

    with progress.stage("cavity"):
        # The paper has a base too, B: its objective gets the base chosen for the profile's lean.
        base = program.choose(options.base, Lean(settings.stability.lean_deg)).base
        paper = paper_density(program, base)
        empty = replace(paper, planes=(None,) * len(program.bodies))
        shell, by_paper = (
            finished(carve(solid, chosen, volume.manifold, program, density), settings.crumb_mm3)
            for chosen, density in ((None, empty), (base, paper))
        )
        marks = (
            mark("solid", solid.manifold),
            mark("shell alone", shell.manifold),
            mark("paper's objective", by_paper.manifold),
        )
    return Exploration(solid.name, settings, points, reachable, marks)


def _point(lean_deg: float, choice: Choice, grams: float) -> Point:
    return Point(
        lean_deg=lean_deg,
        mass_g=choice.volume_mm3 * grams,
        growth_mm=None if choice.base is None else choice.base.growth_mm,
        gap=(choice.volume_mm3 - choice.bound_mm3) / choice.volume_mm3,
    )
