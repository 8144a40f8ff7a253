"""What a file format, or a slicer, cannot take from a part: found out before the long work."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.errors import OutputError, UsageError

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Finding, SlicerName

SUFFIXES = (".3mf", ".stl", ".obj", ".ply")


def check_output(path: Path) -> None:
    """Find out before the long work whether a part can be written to ``path``.

    Raises UsageError for an unknown suffix, OutputError for a folder that is missing, is not
    writable, or stands where the file should.
    """
    if path.suffix.lower() not in SUFFIXES:
        raise UsageError(
            f"{path}: {path.suffix or 'a name without a suffix'} is not a format printprep writes.",
            f"Use one of {', '.join(SUFFIXES)}; .3mf carries the print settings.",
        )
    check_writable(path)


def check_writable(path: Path) -> None:
    """Raise OutputError where a file cannot be written: no such folder, or not writable."""
    if path.is_dir():
        raise OutputError(f"{path} is a folder, not a file.", "Name a file inside it.")
    if not path.parent.is_dir():
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} does not exist.",
            "Make the folder first, or name another one.",
        )
    if not os.access(path.parent, os.W_OK):
        raise OutputError(
            f"{path} cannot be written: the folder {path.parent} is not writable.",
            "Name a folder you may write to.",
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
            f"Infill and its ballast can be written for PrusaSlicer only, not for {slicer}.",
            "Leave out --for, or use --fill cavity.",
        )


def format_findings(
    profile: Profile, path: Path, slicer: SlicerName = "prusa"
) -> tuple[Finding, ...]:
    """Which of the profile's settings the file at ``path`` cannot carry."""
    if slicer != "prusa":
        return (_manual_settings(profile, slicer),)
    suffix = path.suffix.lower()
    if suffix == ".3mf" or not profile.object_settings:
        return ()
    settings = ", ".join(f"{key}={value}" for key, value in sorted(profile.object_settings.items()))
    return (
        finding(
            "no-settings",
            f"A {suffix} file carries no print settings. Mass and tilt angle hold only with "
            f"these: {settings}.",
            "Write a .3mf, or enter them in the slicer.",
        ),
    )


def _manual_settings(profile: Profile, slicer: SlicerName) -> Finding:
    from printprep.output.manual_settings import manual_settings

    program, settings = manual_settings(profile, slicer)
    return finding(
        "set-by-hand",
        f"{program} takes only the shape from this file. Mass and tilt angle hold only with "
        f"these settings: {'; '.join(settings)}.",
        "Enter them before you slice.",
    )
