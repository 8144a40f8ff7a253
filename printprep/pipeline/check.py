"""Look at a file as it is: read, make a solid of it, weigh it, stand it up, run the rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile
    from printprep.types import Finding, Lean


@dataclass(frozen=True, eq=False)
class Examined:
    """A file, what the rules found in it, and the profile they judged by."""

    context: CheckContext
    findings: tuple[Finding, ...]
    profile: Profile


def examine(
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
) -> Examined:
    """Run the rules on a file, placed as ``hollow`` would place it but otherwise as it came.

    Parameters are those of :func:`printprep.hollow`.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.check import context_of_solid, run_rules
    from printprep.mesh.place import place
    from printprep.mesh.read import read_mesh
    from printprep.mesh.repair import repair
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of
    from printprep.stand.stability import stability

    settings = load_profile(profile, overrides or {})
    asked = lean_of(lean, settings.stability.lean_deg)
    with progress.stage("read"):
        raw = read_mesh(Path(model), units)
        placed = place(raw, up=up, scale=scale, height_mm=height_mm, size_mm=size_mm)
    with progress.stage("repair"):
        solid = repair(placed)
    with progress.stage("check"):
        standing = stability(solid.manifold, settings.printer.first_layer_mm)
        context = context_of_solid(solid.manifold, standing, asked, solid.repair, placed)
        findings = run_rules(context, settings)
    return Examined(context, findings, settings)
