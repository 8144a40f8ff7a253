"""The hollowable volume: all that may be cavity, deeper than the wall and without the vaults."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.cavity.surface import cavity_surface
from printprep.cavity.ties import tied
from printprep.errors import UsageError
from printprep.output.prusa_keys import FOR_COLUMNS, blocker_keys
from printprep.supports.blocker import support_blocker
from printprep.supports.policy import supported, vault_choice

if TYPE_CHECKING:
    from collections.abc import Mapping

    from manifold3d import Manifold

    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.progress import Progress
    from printprep.types import Solid, Supports, VaultChoice


@dataclass(frozen=True, eq=False)
class Hollowable:
    """All that may be cavity.

    manifold : the volume without the vaults;  deep : with them, all deeper than the wall.
    depths : below the model's surface, on the grid.
    supports : the vaults, None if there are none.
    blocker : where a slicer makes no supports, None where vaults keep the slicer's rule.
    profile : the profile with the settings that follow from the vaults.
    """

    manifold: Manifold
    deep: Manifold
    depths: Depths
    supports: Supports | None
    blocker: Manifold | None
    profile: Profile

    def program(self, solid: Solid) -> Program:
        """The linear programs of the solid with this volume as its free interior."""
        from printprep.density.program import Program
        from printprep.grid.domain import weigh_interior

        interior = weigh_interior(solid, self.depths, self.manifold)
        return Program(solid.manifold, interior, self.profile)


def hollowable(prepared: Prepared, options: FillOptions, progress: Progress) -> Hollowable:
    """Everything deeper than the wall, with vaults under its ceilings if they are requested."""
    from printprep.grid.depth import measure_depths

    solid, profile = prepared.solid, prepared.profile
    with progress.stage("voxelize"):
        depths = measure_depths(
            solid,
            resolution=options.resolution,
            wall_mm=profile.wall_mm,
            min_feature_mm=profile.min_feature_mm,
            margin_mm=profile.stability.base_growth_max_mm,
        )
    with progress.stage("cavity"):
        deep = tied(cavity_surface(solid.manifold, depths.field, profile.wall_mm))
    if deep.is_empty() or not profile.traits.ceilings_sag:
        return Hollowable(deep, deep, depths, None, None, profile)
    with progress.stage("supports"):
        choice = vault_choice(options.vaults, profile, blocker=options.blocker)
        return _vaulted(deep, depths, prepared, choice, options)


def _vaulted(
    deep: Manifold, depths: Depths, prepared: Prepared, choice: VaultChoice, options: FillOptions
) -> Hollowable:
    """The hollowable volume with the vaults of a choice, and with the blocker that they count on.

    Where walls are too thin for a blocker, the vaults keep the slicer's rule.
    """
    profile, blocker = prepared.profile, None
    if choice != "slicer" and options.blocker:
        assert depths.field is not None  # the volume is not empty
        blocker = support_blocker(prepared.solid.manifold, depths.field, deep, profile)
    if choice == "printer" and blocker is None and options.blocker:
        if options.vaults is not None:
            raise UsageError(
                f"Walls of {profile.wall_mm:g} mm are too thin for a support blocker, which vaults "
                "for the printer need.",
                "Use --vaults slicer, or a thicker --wall.",
            )
        choice = "slicer"
    if blocker is not None:
        profile = _with_settings(
            profile, {**blocker_keys(profile), **profile.slicer.object_settings}
        )
    if choice == "none":
        kept = profile if blocker is None else _without_plate_only(profile)
        return Hollowable(deep, deep, depths, None, blocker, kept)
    volume, supports = supported(deep, profile, choice)
    sure = blocker is not None or not (supports.unsupported_mm2 > 0 or supports.islands)
    kept = _without_plate_only(profile) if sure else profile
    if supports.columns and options.blocker:
        kept = _with_settings(kept, {**FOR_COLUMNS, **kept.slicer.object_settings})
    return Hollowable(volume, deep, depths, supports, blocker, kept)


def _without_plate_only(profile: Profile) -> Profile:
    """The profile without the key that keeps a slicer's supports out of cavities.

    The key also removes outside supports that would rest on the model.
    """
    kept = dict(profile.slicer.object_settings)
    kept.pop("support_material_buildplate_only", None)
    return _with_settings(profile, kept)


def _with_settings(profile: Profile, settings: Mapping[str, str]) -> Profile:
    """The profile with other settings for the slicer."""
    slicer = profile.slicer.model_copy(update={"object_settings": dict(settings)})
    return profile.model_copy(update={"slicer": slicer})
