"""The room for cavities with its ceilings carried from inside, where the process needs that."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.profiles import Profile
    from printprep.types import Supports


def supports_wanted(asked: bool | None, profile: Profile) -> bool:
    """Whether ceilings are to be carried; None leaves it to the process: filament sags.

    Raises UsageError where it is asked of a process whose ceilings need nothing.
    """
    if asked and profile.process != "fdm":
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}: cavities need no supports inside.",
            "Leave --self-support out, or choose an fdm profile.",
        )
    return profile.process == "fdm" if asked is None else asked


def supported(hollowable_volume: Manifold, profile: Profile) -> tuple[Manifold, Supports]:
    """The room with its ceilings carried, and by what."""
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
