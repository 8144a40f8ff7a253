"""Look at a model before hollowing it: its findings, its poses, and what each lean would cost."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.pipeline.check import check_prepared
from printprep.pipeline.options import AS_IN_FILE, FillOptions, Placement
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.pipeline.check import Checked
    from printprep.pipeline.explore import Point
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.stand.poses import Pose
    from printprep.types import Lean


@dataclass(frozen=True, eq=False)
class Looked:
    """A model as it came.

    poses : those in which it stands, the steadiest first.
    points : the least mass at every lean, without vaults, on the base that the requested lean
    needs; empty where nothing can be hollowed, or no filling stands.
    """

    name: str
    checked: Checked
    poses: tuple[Pose, ...]
    points: tuple[Point, ...]


def look(
    model: str | Path,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    placement: Placement = AS_IN_FILE,
    lean: float | str | Lean | None = None,
    progress: Progress = SILENT,
) -> Looked:
    """Check a file, find its poses, and solve the lightest filling at several leans.

    Parameters are those of :func:`printprep.hollow`.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.pipeline.prepare import prepare
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of
    from printprep.stand.poses import stable_poses

    settings = load_profile(profile, overrides or {})
    requested = lean_of(lean, settings.stability.lean_deg)
    prepared = prepare(model, settings, placement, progress)
    checked = check_prepared(prepared, requested, progress)
    return Looked(
        name=prepared.solid.name,
        checked=checked,
        poses=stable_poses(prepared.solid.manifold),
        points=_cost_of_leans(prepared, checked, requested, progress),
    )


def _cost_of_leans(
    prepared: Prepared, checked: Checked, lean: Lean, progress: Progress
) -> tuple[Point, ...]:
    from printprep.pipeline.curve import mass_over_lean
    from printprep.pipeline.hollowable import hollowable

    if checked.context.cavities or checked.context.stability.tilt_deg is None:
        return ()
    volume = hollowable(prepared, FillOptions(vaults="none", blocker=False), progress)
    if volume.manifold.is_empty():
        return ()
    program = volume.program(prepared.solid)
    with progress.stage("solve"):
        base = program.choose("auto", lean).base
        return mass_over_lean(program, base, lean.azimuth_deg)
