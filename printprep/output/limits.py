"""What a file format or a slicer cannot carry, checked before the long work."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.errors import UsageError
from printprep.files import refuse_impossible_target

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Finding, SlicerName, VaultRule

SUFFIXES = (".3mf", ".stl", ".obj", ".ply")
# The slicers that read from a 3MF what a volume is for, and settings of an object.
_READS_VOLUMES: tuple[SlicerName, ...] = ("prusa", "orca")
_WRITE_3MF = "Write a .3mf file for PrusaSlicer, OrcaSlicer or BambuStudio."


def check_output(path: Path) -> None:
    """Check before the long work that a part can be written to ``path``.

    Raises UsageError for an unknown suffix, OutputError if ``path`` is a folder, or if its folder
    is missing or not writable.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(
            f"{path}: {path.suffix or 'a name without a suffix'} is not a format that printprep "
            "writes.",
            f"Use one of {', '.join(SUFFIXES)}; .3mf carries the print settings.",
        )
    check_writable(path)


def check_writable(path: Path) -> None:
    """Raise OutputError before the long work if a file cannot be written."""
    refuse_impossible_target(path)


def check_page(path: Path, option: str) -> None:
    """Check before the long work that a page can be written.

    Raises UsageError for another suffix than .html, OutputError as :func:`check_writable`.
    """
    if path.suffix.lower() not in (".html", ".htm"):
        raise UsageError(
            f"{path}: --{option} writes only .html.", "Name a file that ends in .html."
        )
    check_writable(path)


def check_infill_output(suffix: str, slicer: SlicerName = "prusa") -> None:
    """Raise UsageError for a file that cannot carry infill and ballast."""
    if suffix.lower() != ".3mf":
        raise UsageError(
            f"A {suffix} file cannot carry infill and ballast.",
            "Name an --output that ends in .3mf.",
        )
    if slicer not in _READS_VOLUMES:
        raise UsageError(
            f"Infill and ballast can be written only for PrusaSlicer, OrcaSlicer and BambuStudio, "
            f"not for {slicer}.",
            "Leave out --for, use --for orca, or use --fill cavity.",
        )


def carries_blocker(suffix: str, slicer: SlicerName) -> bool:
    """Whether a file tells its slicer where to make no supports."""
    return suffix.lower() == ".3mf" and slicer in _READS_VOLUMES


def check_blocker(rule: VaultRule, suffix: str, slicer: SlicerName) -> None:
    """Raise UsageError for vaults that count on a blocker in a file that cannot carry it."""
    if rule == "printer" and not carries_blocker(suffix, slicer):
        raise UsageError(
            f"{_what(suffix, slicer)} carries no support blocker, and the vaults count on one: a "
            "slicer with supports on would fill the cavities.",
            "Hollow with vaults='slicer', or write a .3mf file for PrusaSlicer, OrcaSlicer or "
            "BambuStudio.",
        )


def _what(suffix: str, slicer: SlicerName) -> str:
    return f"A {suffix} file" if slicer in _READS_VOLUMES else f"A file for {slicer}"


def vault_findings(
    rule: VaultRule, suffix: str, slicer: SlicerName, *, chosen: bool
) -> tuple[Finding, ...]:
    """What a file that cannot carry a support blocker means for the vaults.

    chosen : the rule was named, not the default.
    """
    if rule == "printer" and not carries_blocker(suffix, slicer):
        return (
            finding(
                "no-blocker",
                f"{_what(suffix, slicer)} carries no support blocker: a slicer with supports on "
                "fills the cavities.",
                "Slice without supports, or use --vaults slicer.",
            ),
        )
    if rule == "slicer" and not chosen:
        why = (
            "The walls are too thin for a support blocker"
            if carries_blocker(suffix, slicer)
            else f"{_what(suffix, slicer)} carries no support blocker"
        )
        return (
            finding(
                "vaults-for-slicer",
                f"{why}, so the vaults keep the slicer's overhang rule: more of them, and a longer "
                "print.",
                _WRITE_3MF if not carries_blocker(suffix, slicer) else "Use a thicker --wall.",
            ),
        )
    return ()


def format_findings(
    profile: Profile, path: Path, slicer: SlicerName = "prusa", *, infill: bool = False
) -> tuple[Finding, ...]:
    """The profile's settings that the file at ``path`` cannot carry, as findings.

    infill : the part is printed with the profile's infill, not with cavities.
    """
    suffix = path.suffix.lower()
    if slicer != "prusa" and not carries_blocker(suffix, slicer):
        return (_manual_settings(profile, slicer),)
    if slicer != "prusa":
        return (_print_settings(profile, slicer, infill),)
    if suffix == ".3mf" or not profile.object_settings:
        return ()
    settings = ", ".join(f"{key}={value}" for key, value in sorted(profile.object_settings.items()))
    return (
        finding(
            "no-settings",
            f"A {suffix} file carries no print settings. Mass and tilt angle hold only with "
            f"these: {settings}.",
            "Write a .3mf file, or enter these settings in the slicer.",
        ),
    )


def _manual_settings(profile: Profile, slicer: SlicerName) -> Finding:
    from printprep.output.manual_settings import manual_settings

    program, settings = manual_settings(profile, slicer)
    return finding(
        "set-by-hand",
        f"{program} takes only the shape from this file. Mass and tilt angle hold only with "
        f"these settings: {'; '.join(settings)}.",
        "Enter these settings before you slice.",
    )


def _print_settings(profile: Profile, slicer: SlicerName, infill: bool) -> Finding:
    """The settings of a print, where the file carries those of the object."""
    from printprep.output.manual_settings import manual_settings, object_settings_in_words
    from printprep.output.orca_keys import object_settings, orca_settings
    from printprep.output.prusa_keys import DENSE, object_keys

    program, settings = manual_settings(profile, slicer, carried=True)
    carried = object_settings(object_keys(profile) if infill else profile.object_settings)
    words = "; ".join(object_settings_in_words(carried))
    if infill:
        words += (
            f"; and for the ballast: {'; '.join(object_settings_in_words(orca_settings(DENSE)))}"
        )
    return finding(
        "set-by-hand",
        f"{program} takes the settings of the object from this file, but not those of the print. "
        f"Mass and tilt angle hold only with these settings: {'; '.join(settings)}.",
        "Enter these settings before you slice. Where the object then shows no settings of its own "
        f"(BambuStudio may drop those of another program), enter them too: {words}.",
    )
