"""Whether vaults carry the ceilings of cavities, and the hollowable volume with vaults."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.profiles import Profile
    from printprep.types import Supports


def supports_wanted(requested: bool | None, profile: Profile) -> bool:
    """Whether vaults carry the ceilings; None stands for "if ceilings sag in the process".

    Raises UsageError if vaults are requested and ceilings of the process need none.
    """
    if requested and not profile.traits.ceilings_sag:
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}, where ceilings need no vaults.",
            "Leave out --self-support, or choose a profile for filament.",
        )
    return profile.traits.ceilings_sag if requested is None else requested


def supported(hollowable_volume: Manifold, profile: Profile) -> tuple[Manifold, Supports]:
    """The hollowable volume without its vaults, and figures of the vaults."""
    from printprep.supports import vaulted
    from printprep.types import Supports

    vaults = vaulted(hollowable_volume, profile)
    return vaults.cavity, Supports(
        vaults.capitals,
        vaults.columns,
        vaults.added_mm3,
        vaults.unsupported_mm2,
        vaults.islands,
    )
