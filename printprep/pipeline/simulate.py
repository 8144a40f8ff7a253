"""Try a file out in simulation: read it, make a solid of it, let it go, lean it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Finding, Lean, Simulation, Solid, Stability


@dataclass(frozen=True, eq=False)
class TriedOut:
    """A file, how it stands as computed and as simulated, and what follows from it."""

    solid: Solid
    stability: Stability
    simulation: Simulation
    lean: Lean
    profile: Profile
    findings: tuple[Finding, ...]


def try_out(
    model: str | Path,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    units: str | None = None,
    up: str = "+z",
    scale: float | None = None,
    height_mm: float | None = None,
    size_mm: float | None = None,
    lean: float | str | Lean | None = None,
    progress: Progress = SILENT,
) -> TriedOut:
    """Simulate a file, placed as ``hollow`` would place it but otherwise as it came.

    Parameters are those of :func:`printprep.hollow`; of the profile only the first layer and the
    lean matter.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.check.registry import sorted_findings
    from printprep.check.simulated import simulation_findings
    from printprep.mesh.place import place
    from printprep.mesh.read import read_mesh
    from printprep.mesh.repair import repair
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of
    from printprep.stand.stability import stability
    from printprep.stand.trial import trial

    settings = load_profile(profile, overrides or {})
    asked = lean_of(lean, settings.stability.lean_deg)
    with progress.stage("read"):
        raw = read_mesh(Path(model), units)
        placed = place(raw, up=up, scale=scale, height_mm=height_mm, size_mm=size_mm)
    with progress.stage("repair"):
        solid = repair(placed)
    first_layer = settings.printer.first_layer_mm
    with progress.stage("simulate"):
        standing = stability(solid.manifold, first_layer)
        simulation = trial(solid.manifold, first_layer, asked)
    findings = sorted_findings(simulation_findings(simulation, asked))
    return TriedOut(solid, standing, simulation, asked, settings, findings)
