"""Reads the settings of OrcaSlicer and Bambu Studio: JSON for process, filament and machine.

A file has the settings that differ from those that it builds on ("inherits"), which is another file
with that "name".  What a file builds on counts where it is given too.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from printprep.errors import InputError, UsageError
from printprep.profile_import.dialects import ORCA
from printprep.profile_import.settings import Setting, Settings
from printprep.wording import shortened

Preset = Mapping[str, Any]


def settings_of_json(texts: Sequence[tuple[str, str]]) -> Settings:
    """The settings in several files, each (name of the file, its text).

    Raises InputError for a text that is no such file; UsageError where two files that do not build
    on each other have different values.
    """
    presets = [(file, _preset(file, text)) for file, text in texts]
    named = [(_word(preset, "name"), file, preset) for file, preset in presets]
    by_name = {name: (file, preset) for name, file, preset in named if name}
    if len(by_name) < sum(bool(name) for name, _, _ in named):
        raise UsageError("Two of the files have the same name inside.", "Give one of them.")
    parents = {_word(preset, "inherits") for _, preset in presets} - {""}
    values: dict[str, Setting] = {}
    absent: list[str] = []
    used: set[str] = set()
    for _, file, preset in (item for item in named if item[0] not in parents):
        for key, setting in _inherited(file, preset, by_name, absent, used).items():
            there = values.setdefault(key, setting)
            if there.value != setting.value and key in ORCA.names:
                raise UsageError(
                    f"{key} differs between {there.file} and {setting.file}.",
                    "Give one process, one filament and one machine.",
                )
    for file, _ in presets:
        if file not in used:  # it is in a circle
            raise InputError(f"{file} inherits from itself.", "Export the settings again.")
    return Settings(ORCA, values, tuple(dict.fromkeys(absent)))


def _preset(file: str, text: str) -> Preset:
    try:
        data = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"{file} is not valid JSON: {shortened(str(error), 100)}.", "Export it again."
        ) from error
    if not isinstance(data, dict):
        raise InputError(f"{file} holds no settings.", "Give JSON that OrcaSlicer exported.")
    return data


def _inherited(
    file: str,
    preset: Preset,
    by_name: Mapping[str, tuple[str, Preset]],
    absent: list[str],
    used: set[str],
) -> dict[str, Setting]:
    """The settings of a file on top of those that it builds on.

    ``absent`` gets the name of what is missing, ``used`` the files.
    """
    values: dict[str, Setting] = {}
    seen: set[str] = set()
    while True:
        if file in seen:
            raise InputError(f"{file} inherits from itself.", "Export the settings again.")
        seen.add(file)
        used.add(file)
        for key, value in preset.items():
            setting = _setting(file, value)
            if setting is not None:
                values.setdefault(key, setting)
            elif key in ORCA.names:
                raise InputError(f"{file}: {key} is not a text, a number or a list of them.")
        above = _word(preset, "inherits")
        if above not in by_name:
            absent += [above] if above else []
            return values
        file, preset = by_name[above]


def _word(preset: Preset, key: str) -> str:
    """A name in a preset, "" where there is none."""
    value = preset.get(key)
    return value if isinstance(value, str) else ""


def _setting(file: str, value: object) -> Setting | None:
    """None for a value that is no setting (a table, true, nothing)."""
    if isinstance(value, list):
        texts = [_text(item) for item in value]
        return None if None in texts else Setting(tuple(t for t in texts if t is not None), file)
    text = _text(value)
    return None if text is None else Setting(text, file)


def _text(value: object) -> str | None:
    if isinstance(value, bool) or not isinstance(value, str | int | float):
        return None
    return value if isinstance(value, str) else repr(value)
