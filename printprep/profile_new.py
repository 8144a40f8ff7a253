"""Writes profiles of the user's own, into their folder."""

from __future__ import annotations

from pathlib import Path

from printprep.errors import OutputError, UsageError
from printprep.files import reason_of, write_atomically
from printprep.profile_folders import user_profile_path
from printprep.profiles import load_profile, profile_source


def copied_text(name: str, base: str | Path) -> str:
    """TOML for a profile that begins as a copy of another, comments included.

    Raises UsageError where ``base`` is not a profile.
    """
    load_profile(base)
    called = Path(base).stem if str(base).endswith(".toml") else str(base)
    return (
        f"# Profile {name}: a copy of {called}, made to be edited.\n"
        f"# `printprep profiles show {name} --json` checks it and shows every key.\n"
        "# Lengths are mm, densities g/cm³, angles degrees.\n"
        "#\n"
        f"# What follows is {called}, with its comments.  Change them with the figures.\n\n"
        f"{profile_source(base).lstrip()}"
    )


def write_user_profile(name: str, text: str, *, replace: bool) -> Path:
    """Write a profile of the user's own; return its file.

    Raises UsageError for a name that cannot be one (:func:`user_profile_path`), or that is there
    already unless ``replace``; OutputError where the file cannot be written.
    """
    path = user_profile_path(name)
    check_may_write(path, replace=replace)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OutputError(
            f"The folder for your profiles, {path.parent}, cannot be made: {reason_of(error)}.",
            "Name another folder in the variable PRINTPREP_PROFILES.",
        ) from error
    write_atomically(path, text.encode())
    return path


def check_may_write(path: Path, *, replace: bool) -> None:
    """Raise UsageError where a file is there that may not be replaced."""
    if not replace and (path.exists() or path.is_symlink()):
        raise UsageError(
            f"You have a profile {path.stem} already: {path}.",
            "Choose another name, or replace it with --force.",
        )
