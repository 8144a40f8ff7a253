"""The hollowable volume: all that may be cavity, deeper than the wall and without the vaults."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from printprep.cavity.surface import cavity_surface
from printprep.cavity.ties import tied
from printprep.supports.policy import supported, supports_wanted

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.density.program import Program
    from printprep.grid.depth import Depths
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.progress import Progress
    from printprep.types import Solid, Supports


@dataclass(frozen=True, eq=False)
class Hollowable:
    """All that may be cavity.

    manifold : the volume without the vaults;  depths : below the model's surface, on the grid.
    supports : the vaults, None if there are none.
    profile : the profile with the settings that follow from the vaults.
    """

    manifold: Manifold
    depths: Depths
    supports: Supports | None
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
        manifold = tied(cavity_surface(solid.manifold, depths.field, profile.wall_mm))
    if manifold.is_empty() or not supports_wanted(options.self_support, profile):
        return Hollowable(manifold, depths, None, profile)
    with progress.stage("supports"):
        manifold, supports = supported(manifold, profile)
    return Hollowable(manifold, depths, supports, _without_plate_only(profile, supports))


def _without_plate_only(profile: Profile, supports: Supports) -> Profile:
    """The profile without the key that keeps a slicer's supports out of cavities, if none go there.

    The key also removes outside supports that would rest on the model.
    """
    if supports.unsupported_mm2 > 0 or supports.islands:
        return profile
    kept = dict(profile.slicer.object_settings)
    kept.pop("support_material_buildplate_only", None)
    slicer = profile.slicer.model_copy(update={"object_settings": kept})
    return profile.model_copy(update={"slicer": slicer})
