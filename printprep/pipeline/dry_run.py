"""What a job would do: everything is checked, the model is read and placed, nothing is written."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.pipeline.job import Job, check_job, check_settings, vaults_of
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Lean, Model, VaultChoice


@dataclass(frozen=True)
class DryRun:
    """What a job would do.

    size_mm : x, y, z of the model, placed;  triangles : of the model, welded.
    vaults : the rule that they would keep, None where the fill has none.
    """

    job: Job
    profile: Profile
    size_mm: tuple[float, float, float]
    triangles: int
    lean: Lean
    vaults: VaultChoice | None


def dry_run(job: Job, progress: Progress = SILENT, *, into_new_folder: bool = False) -> DryRun:
    """Check a job as :func:`printprep.pipeline.job.run_job` would, and read and place its model.

    The model is repaired only where a pose is asked for, which needs a solid.

    into_new_folder : the folder of the output is not there yet, and will be made.

    Raises
    ------
    UsageError, InputError, GeometryError, OutputError, ToolError : as ``run_job`` up to there.
    """
    from printprep.stand.lean import lean_of

    profile = check_settings(job) if into_new_folder else check_job(job)
    vaults = vaults_of(job, profile) if job.options.fill == "cavity" else None
    placed = _placed(job, profile, progress)
    x, y, z = (float(side) for side in placed.vertices.max(axis=0) - placed.vertices.min(axis=0))
    lean = lean_of(job.options.lean, profile.stability.lean_deg)
    return DryRun(job, profile, (x, y, z), len(placed.faces), lean, vaults)


def _placed(job: Job, profile: Profile, progress: Progress) -> Model:
    from printprep.pipeline.limits import check_memory, check_size
    from printprep.pipeline.prepare import placed_model, prepare

    resolution, memory = job.options.resolution, job.options.max_memory_mib
    if job.placement.pose is not None:
        prepared = prepare(
            job.model, profile, job.placement, progress,
            resolution=resolution, max_memory_mib=memory,
        )  # fmt: skip
        return prepared.model
    with progress.stage("read"):
        placed = placed_model(job.model, job.placement)
    check_size(placed, profile, job.placement)
    check_memory(placed, profile, resolution, memory)
    return placed
