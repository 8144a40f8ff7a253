"""Simulate a file: read it, make it into a solid, let it stand freely, tilt the bed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.pipeline.options import AS_IN_FILE, Placement
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Finding, Lean, Simulation, Solid, Stability


@dataclass(frozen=True, eq=False)
class Simulated:
    """A simulated file: how it stands as computed and as simulated, and the findings."""

    solid: Solid
    stability: Stability
    simulation: Simulation
    lean: Lean
    profile: Profile
    findings: tuple[Finding, ...]


def simulate(
    model: str | Path,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    placement: Placement = AS_IN_FILE,
    lean: float | str | Lean | None = None,
    progress: Progress = SILENT,
) -> Simulated:
    """Simulate a file, placed as ``hollow`` places it but otherwise as it came.

    Parameters are those of :func:`printprep.hollow`; of the profile only the first layer and the
    lean count.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.check import sorted_findings
    from printprep.check.reading import reading_findings
    from printprep.check.simulated import simulation_findings
    from printprep.pipeline.prepare import prepare
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of
    from printprep.stand.stability import stability
    from printprep.stand.trial import trial

    settings = load_profile(profile, overrides or {})
    requested = lean_of(lean, settings.stability.lean_deg)
    prepared = prepare(model, settings, placement, progress)
    solid = prepared.solid
    first_layer_mm = settings.printer.first_layer_mm
    with progress.stage("simulate"):
        part_stability = stability(solid.manifold, first_layer_mm)
        simulation = trial(solid.manifold, first_layer_mm, requested)
    findings = sorted_findings(
        [*reading_findings(prepared.model.notes), *simulation_findings(simulation, requested)]
    )
    return Simulated(solid, part_stability, simulation, requested, settings, findings)


def draw_fall(
    simulated: Simulated,
    *,
    gif: Path | None = None,
    strip: Path | None = None,
    progress: Progress = SILENT,
) -> None:
    """Draw the bed tilting toward the weakest edge: a GIF, a strip of PNG stills, or both.

    Raises OutputError if a file cannot be written.
    """
    if gif is None and strip is None:
        return
    from printprep.files import write_atomically
    from printprep.render import animation
    from printprep.stand.fall import film

    part = simulated.solid.manifold
    first_layer_mm = simulated.profile.printer.first_layer_mm
    with progress.stage("draw"):
        if gif is not None:
            moving = film(part, first_layer_mm, animation.GIF_FRAMES_PER_S)
            write_atomically(gif, animation.gif_bytes(moving))
        if strip is not None:
            stills = film(part, first_layer_mm, animation.STRIP_FRAMES_PER_S)
            write_atomically(strip, animation.strip_bytes(stills))
