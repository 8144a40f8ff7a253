"""Which profiles and options go with an infill print, checked before the long work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.objectives import DEFAULT_OBJECTIVE

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import VaultChoice


def check_infill(profile: Profile, *, objective: str, vaults: VaultChoice | None) -> None:
    """Raise UsageError if an option is for cavities only, or if the profile has no infill."""
    if not profile.traits.has_nozzle:
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}, which prints without infill.",
            "Use --fill cavity, or choose a profile for filament.",
        )
    if profile.infill is None:
        raise UsageError(
            f"Profile {profile.name} has no infill.",
            "Set pattern and density, in a table [infill] of the profile or with --set "
            "infill.pattern=lightning --set infill.density=0.15.",
        )
    if objective != DEFAULT_OBJECTIVE:
        raise UsageError(
            f"The objective {objective} makes only cavities, not infill.",
            "Leave out --objective, or use --fill cavity.",
        )
    if vaults in ("printer", "slicer"):
        raise UsageError(
            f"--vaults {vaults} has no effect with infill: the infill carries the ceilings.",
            "Leave out --vaults, or use --fill cavity.",
        )
    if profile.drain.count:
        raise UsageError(
            "A part with infill has no cavities to drain.",
            "Leave out --drains (profile key drain.count), or use --fill cavity.",
        )
