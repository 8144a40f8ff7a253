"""Which profiles and options go with an infill print: found out before the long work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.profiles import Profile


def check_infill(profile: Profile, *, objective: str, self_support: bool) -> None:
    """Raise UsageError where an option belongs to cavities, or the profile has no infill."""
    if not profile.traits.has_nozzle:
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}, which prints without infill.",
            "Leave out --fill, or choose a profile for filament.",
        )
    if profile.infill is None:
        raise UsageError(
            f"Profile {profile.name} has no infill.",
            "Add a table [infill] with pattern and density to it, or set them: "
            "--set infill.pattern=lightning --set infill.density=0.15.",
        )
    if objective != "lean":
        raise UsageError(
            f"The objective {objective} makes cavities; it has no sparse infill.",
            "Leave out --objective, or use --fill cavity.",
        )
    if self_support:
        raise UsageError(
            "With infill there is no cavity to support: the infill carries the ceilings.",
            "Leave out --self-support, or use --fill cavity.",
        )
    if profile.drain.count:
        raise UsageError(
            "With infill there is no cavity to drain.",
            "Leave out --drains (key drain.count), or use --fill cavity.",
        )
