"""Check a file as it is: read it, make it into a solid, weigh and balance it, run the rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.pipeline.options import AS_IN_FILE, Placement
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.check.context import CheckContext
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.types import Finding, Lean


@dataclass(frozen=True, eq=False)
class Checked:
    """A checked file, its findings, and the profile that it was checked against."""

    context: CheckContext
    findings: tuple[Finding, ...]
    profile: Profile

    @property
    def mass_g(self) -> float:
        """Mass of the file in the profile's material."""
        return float(self.context.part.volume()) * self.profile.material.density_g_cm3 / 1000


def check(
    model: str | Path,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    placement: Placement = AS_IN_FILE,
    lean: float | str | Lean | None = None,
    max_memory_mib: float | None = None,
    progress: Progress = SILENT,
) -> Checked:
    """Run the rules on a file, placed as ``hollow`` places it but otherwise as it came.

    Parameters are those of :func:`printprep.hollow`.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.pipeline.prepare import prepare
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of

    settings = load_profile(profile, overrides or {})
    requested = lean_of(lean, settings.stability.lean_deg)
    prepared = prepare(model, settings, placement, progress, max_memory_mib=max_memory_mib)
    return check_prepared(prepared, requested, progress)


def check_prepared(prepared: Prepared, lean: Lean, progress: Progress = SILENT) -> Checked:
    """Run the rules on a model that was prepared already."""
    from printprep.check import context_of_solid, run_rules, sorted_findings
    from printprep.check.reading import reading_findings
    from printprep.stand.stability import stability

    solid, part, settings = prepared.solid, prepared.solid.manifold, prepared.profile
    with progress.stage("check"):
        part_stability = stability(part, settings.printer.first_layer_mm)
        blocker = _blocker(prepared)
        context = context_of_solid(
            part, part_stability, lean, solid.repair, prepared.model, blocker
        )
        read = reading_findings(prepared.model.notes)
        findings = sorted_findings([*read, *run_rules(context, settings)])
    return Checked(context, findings, settings)


def _blocker(prepared: Prepared) -> Manifold | None:
    """Where the file tells a slicer to make no supports, on the bed; None where it does not.

    A blocker that is no solid blocks nothing that a slicer could rely on, so it is left out.
    """
    from printprep.check.walls import united
    from printprep.mesh.measure import try_manifold

    to_bed = prepared.solid.placement
    sound = []
    for vertices, faces in prepared.model.blockers:
        solid, status = try_manifold(vertices @ to_bed[:3, :3].T + to_bed[:3, 3], faces)
        if status == "NoError" and solid.volume() > 0:
            sound.append(solid)
    return united(sound) if sound else None
