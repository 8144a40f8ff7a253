"""What goes together with an infill print, found out before the long work."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from pathlib import Path

    from printprep.profiles import Profile
    from printprep.types import SlicerName


def check_fill(
    fill: str, profile: Profile, *, objective: str, self_support: bool, slicer: Path | None
) -> None:
    """Raise UsageError where an option belongs to the other way to fill, or the profile does."""
    if fill == "cavity":
        if slicer is not None:
            raise UsageError(
                "A slicer is asked only to weigh a print with infill.",
                "Add --fill infill, or leave out --slicer.",
            )
        return
    if profile.process != "fdm":
        raise UsageError(
            f"Profile {profile.name} is for {profile.process}, which prints without infill.",
            "Leave out --fill, or choose an fdm profile.",
        )
    if profile.infill is None:
        raise UsageError(
            f"Profile {profile.name} says nothing of infill.",
            "Add a table [infill] with pattern and density to it, or set them: "
            "--set infill.pattern=lightning --set infill.density=0.15.",
        )
    if objective != "lean":
        raise UsageError(
            "The paper's objective carves cavities; it knows no sparse infill.",
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


def check_infill_output(suffix: str, slicer: SlicerName = "prusa") -> None:
    """Raise UsageError for a file that cannot carry infill and ballast."""
    if suffix.lower() != ".3mf":
        raise UsageError(
            f"A {suffix} file cannot carry infill and its ballast.",
            "Name an --output that ends with .3mf.",
        )
    if slicer != "prusa":
        raise UsageError(
            f"Infill and its ballast are written in PrusaSlicer's words, not for {slicer}.",
            "Leave out --for, or use --fill cavity.",
        )
