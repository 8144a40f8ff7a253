"""From files of a slicer to a profile and its text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from printprep.errors import InputError, UsageError
from printprep.input_file import read_plain_file
from printprep.profile_import.keys import Missing, Taken, keys_of
from printprep.profile_import.orca_file import settings_of_json
from printprep.profile_import.prusa_file import settings_of_ini
from printprep.profile_import.settings import Settings
from printprep.profile_import.text import profile_text
from printprep.profiles import Profile, load_profile
from printprep.wording import printable

_BYTES_MAX = 32 << 20


@dataclass(frozen=True)
class Imported:
    """A profile from a slicer's settings.

    taken, missing : its keys that the files have, and those that they lack and ``base`` gave.
    absent : names of settings that those in the files build on, in no file given.
    text : the TOML.
    """

    profile: Profile
    base: str
    program: str
    taken: tuple[Taken, ...]
    missing: tuple[Missing, ...]
    absent: tuple[str, ...]
    text: str


def import_profile(
    name: str, files: Sequence[Path], base: str, sections: Sequence[str] = ()
) -> Imported:
    """The profile that the settings in some files make, with what they lack taken from ``base``.

    Raises InputError for a file that is none of a slicer's settings, or whose values no profile can
    have; UsageError for a base that is not for filament, and for sections.
    """
    start = load_profile(base)
    if not start.traits.has_nozzle:
        raise UsageError(
            f"Profile {start.name} is for {start.process}, and slicers' settings are for filament.",
            "Name a profile for filament with --from.",
        )
    settings = _settings(files, sections)
    taken, missing = keys_of(settings)
    shown = ", ".join(file.name for file in files)
    if not taken:
        raise InputError(
            f"{shown}: none of the settings that a profile takes is there.",
            f"They are {', '.join(settings.dialect.names)}.",
        )
    taken = (*taken, *_walls(taken, start))
    try:
        profile = load_profile(base, {item.key: item.value for item in taken})
    except UsageError as error:
        raise InputError(
            f"The settings in {shown} make no profile. {error.message}",
            "Change them in the slicer and export them again, or choose another --from.",
        ) from error
    profile = profile.model_copy(update={"name": name})
    text = profile_text(
        profile,
        {item.key: printable(item.origin) for item in taken},
        f"from {start.name}",
        printable(f"Profile {name}, imported from {shown} ({settings.dialect.program})."),
    )
    return Imported(
        profile, start.name, settings.dialect.program, taken, missing, settings.absent, text
    )


def _settings(files: Sequence[Path], sections: Sequence[str]) -> Settings:
    texts = [(file.name, _text(file)) for file in files]
    kinds = {text.lstrip()[:1] in ("{", "[") and _is_json(text) for _, text in texts}
    if len(kinds) > 1:
        raise UsageError(
            "The files are of different slicers.", "Import those of one slicer at a time."
        )
    if kinds == {True}:
        if sections:
            raise UsageError("JSON has no sections.", "Leave out --section.")
        return settings_of_json(texts)
    if len(files) > 1:
        raise UsageError(
            "Of PrusaSlicer's files one is imported: it holds all settings.",
            "Export it with File > Export > Export Config.",
        )
    return settings_of_ini(texts[0][1], texts[0][0], sections)


def _is_json(text: str) -> bool:
    """A list in JSON is told from a section of an .ini by its first line."""
    first = text.lstrip()
    return first[0] == "{" or "]" not in first.partition("\n")[0] or first[1:2] in ('"', "{", "[")


def _text(file: Path) -> str:
    data = read_plain_file(file, _BYTES_MAX)
    if data[:2] == b"PK":
        raise InputError(
            f"{file} is an archive.", "Unpack it, and name the JSON files that are inside."
        )
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(
            f"{file} is not text.", "Give the .ini or JSON that a slicer exported."
        ) from error


def _walls(taken: Sequence[Taken], base: Profile) -> list[Taken]:
    """Walls and columns of two lines, where those of the base are thinner than a single line."""
    widths = [item.value for item in taken if item.key == "printer.line_width_mm"]
    if not widths or not isinstance(widths[0], float):
        return []
    two_mm = round(2 * widths[0], 4)
    return [
        Taken(key, two_mm, "two lines of printer.line_width_mm")
        for key in ("wall_mm", "min_feature_mm")
        if getattr(base, key) < widths[0]
    ]
