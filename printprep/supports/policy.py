"""Which overhang rule vaults are built for, and the hollowable volume with vaults."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.types import VAULT_CHOICES, VaultChoice

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.profiles import Profile
    from printprep.types import Supports, VaultRule


def vault_choice(
    requested: VaultChoice | None, profile: Profile, *, blocker: bool = True
) -> VaultChoice:
    """The choice; None stands for no vaults, or where ceilings sag for the printer's rule.

    blocker : whether a support blocker is made; without one, None stands for the slicer's rule.

    Raises UsageError for an unknown choice, or if vaults are requested and ceilings of the process
    need none.
    """
    if requested not in (None, *VAULT_CHOICES):
        raise UsageError(
            f"There are no vaults {requested!r}.", f"The choices are {', '.join(VAULT_CHOICES)}."
        )
    sag = profile.traits.ceilings_sag
    if requested in ("printer", "slicer") and not sag:
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}, where ceilings need no vaults.",
            f"Leave out --vaults {requested}, or choose a profile for filament.",
        )
    by_default: VaultChoice = "printer" if blocker else "slicer"
    return requested or (by_default if sag else "none")


def supported(
    hollowable_volume: Manifold, profile: Profile, rule: VaultRule
) -> tuple[Manifold, Supports]:
    """The hollowable volume without its vaults, and figures of the vaults."""
    from printprep.supports import vaulted
    from printprep.types import Supports

    vaults = vaulted(hollowable_volume, profile, rule)
    return vaults.cavity, Supports(
        rule,
        vaults.capitals,
        vaults.columns,
        vaults.added_mm3,
        vaults.unsupported_mm2,
        vaults.islands,
    )
