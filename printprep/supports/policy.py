"""The hollowable volume with its ceilings carried by vaults, where the process needs that."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.profiles import Profile
    from printprep.types import Supports


def supports_wanted(asked: bool | None, profile: Profile) -> bool:
    """Whether vaults carry the ceilings; None asks for them where the process lets ceilings sag.

    Raises UsageError where vaults are asked for and ceilings of that process need none.
    """
    if asked and not profile.traits.ceilings_sag:
        raise UsageError(
            f"Ceilings need no vaults in {profile.process} (profile {profile.name}).",
            "Leave --self-support out, or choose a profile for filament.",
        )
    return profile.traits.ceilings_sag if asked is None else asked


def supported(hollowable_volume: Manifold, profile: Profile) -> tuple[Manifold, Supports]:
    """The hollowable volume with its ceilings carried by vaults, and what the vaults are."""
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
