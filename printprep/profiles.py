"""Reads profiles: one printer, material and process each, from TOML, by name or by path.

A profile is named after its file.  Lengths are mm, densities g/cm³, angles degrees; overhang_deg is
measured from the vertical.  In the profiles that come with printprep, a comment beside each figure
names its source (:func:`profile_source`).

This module imports pydantic: import it inside the function that needs it, not at start-up.
"""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError

from printprep.errors import InputError, UsageError
from printprep.input_file import read_plain_file
from printprep.profile_folders import (
    DEFAULT_PROFILE,
    find_profile,
    profile_names,
    shipped_folder,
    user_folder,
    user_profile_names,
)
from printprep.profile_schema import Profile
from printprep.wording import nearest, shortened

__all__ = [
    "DEFAULT_PROFILE",
    "Profile",
    "load_profile",
    "profile_names",
    "profile_source",
    "user_profile_names",
]

_PROFILE_BYTES_MAX = 1 << 20
_FACTS_MAX = 8


def profile_source(name: str | Path) -> str:
    """TOML text of a profile, comments and sources included; `name` as for load_profile."""
    path = find_profile(name)
    try:
        # A mark of the byte order, as some editors write one, is no part of the text.
        return read_plain_file(path, _PROFILE_BYTES_MAX).decode("utf-8-sig")
    except InputError as error:
        raise UsageError(f"The profile cannot be read: {error.message}", error.hint) from error
    except UnicodeDecodeError as error:
        raise UsageError(f"The profile {name} cannot be read: {error}.") from error


def load_profile(
    name_or_path: str | Path | Profile = DEFAULT_PROFILE,
    overrides: Mapping[str, object] = {},
) -> Profile:
    """The profile with this name, at this path, or the given one, with single keys overridden.

    overrides : dotted key → value, as {"stability.lean_deg": 12}.  A string that is a TOML value
    ("12", "true") becomes that value; any other string ("100%") stays text.

    Raises UsageError that names the file, the key and the allowed range.
    """
    if isinstance(name_or_path, Profile):
        source, data = f"Profile {name_or_path.name}", name_or_path.model_dump()
    else:
        path = find_profile(name_or_path)
        source = _called(path, name_or_path)
        data = _parsed(profile_source(name_or_path), source)
        if "name" in data:
            raise UsageError(
                f"{source}: name is not a key of a profile.", "A profile is named after its file."
            )
        data["name"] = path.stem
    for key, value in overrides.items():
        if key == "name":
            raise UsageError(
                "The name of a profile cannot be overridden.", "A profile is named after its file."
            )
        _override(data, key, value)
    try:
        return Profile.model_validate(data)
    except ValidationError as error:
        raise _explain(error, source, overrides) from error


def _parsed(text: str, source: str) -> dict[str, Any]:
    """TOML as a dict.  Raises UsageError, which begins with ``source``."""
    try:
        return tomllib.loads(text)
    except RecursionError as error:
        raise UsageError(f"{source} is not a profile: its values are nested too deep.") from error
    except ValueError as error:  # TOMLDecodeError, or a number with thousands of digits
        raise UsageError(f"{source} is not valid TOML: {shortened(str(error), 200)}.") from error


def _called(path: Path, name: str | Path) -> str:
    """What messages call a profile: by its name where it has one, the user's own with its file."""
    if path.parent == shipped_folder():
        return f"Profile {path.stem}"
    return f"Profile {path.stem} ({path})" if path.parent == user_folder() else str(name)


def _override(data: dict[str, Any], key: str, value: object) -> None:
    *tables, last = key.split(".")
    for table in tables:
        data = data.setdefault(table, {})
        if not isinstance(data, dict):
            raise UsageError(f"{key} is not a key of a profile: {table} is not a table.")
    data[last] = _toml_value(value) if isinstance(value, str) else value


def _toml_value(text: str) -> object:
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):  # TOMLDecodeError, thousands of digits, deep nesting
        return text
    return parsed["value"] if len(parsed) == 1 else text


def _explain(error: ValidationError, source: str, overrides: Mapping[str, object]) -> UsageError:
    facts: dict[str, str] = {}
    for item in error.errors(include_url=False):
        path = tuple(part for part in item["loc"] if isinstance(part, str))
        key = item.get("ctx", {}).get("key") or ".".join(path)
        facts.setdefault(key, _fact(item["type"], path, item))  # a list's items count as one
    if overrides:
        source = f"{source} with the keys that were set"
    lines = [f"{shortened(key)} {fact}" for key, fact in facts.items()]
    if len(lines) > _FACTS_MAX:
        lines[_FACTS_MAX:] = [f"and {len(lines) - _FACTS_MAX} more"]
    message = f"{source}: {'; '.join(lines)}"
    return UsageError(
        message if message.endswith("?") else f"{message}.",
        "`printprep profiles show NAME` shows every key in use.",
    )


def _fact(kind: str, path: tuple[str, ...], item: Mapping[str, Any]) -> str:
    if kind in ("impossible", "forbidden"):
        return str(item["msg"])
    if kind == "unknown":
        return f"is {_shown(item['input'])}, {item['msg']}"
    owner = _model_at(path[:-1])
    allowed = _allowed(owner, path[-1]) if owner else ""
    if kind == "extra_forbidden" and owner:
        close = _nearest_key(path)
        if close is not None:
            return f"is unknown; did you mean {close}?"
        keys = ", ".join(key for key in owner.model_fields if key != "name" or owner is not Profile)
        return f"is unknown; allowed here: {keys}"
    if kind == "missing" and isinstance(item["loc"][-1], str):
        return f"is missing; it {allowed}" if allowed else "is missing"
    if not isinstance(item["loc"][-1], str):
        return allowed or _must_be(item["msg"])
    return f"is {_shown(item['input'])}, {allowed or _must_be(item['msg'])}"


def _nearest_key(path: tuple[str, ...]) -> str | None:
    """The key that was probably meant, in the same table if it has one of about that name."""
    keys = tuple(_keys_below(Profile))
    last = {key: key.rpartition(".")[2] for key in keys}
    table = ".".join(path[:-1])
    here = [key for key in keys if key.rpartition(".")[0] == table]
    same = [key for key in keys if last[key] == path[-1]]
    for some in (here, same, keys):
        close = nearest(path[-1], [last[key] for key in some])
        if close is not None:
            return next(key for key in some if last[key] == close)
    return None


def _keys_below(model: type[BaseModel], above: str = "") -> Iterator[str]:
    """All keys of a profile, a key in a table as "table.key"; the tables too."""
    for name in model.model_fields:
        if model is Profile and name == "name":
            continue
        yield above + name
        inner = _model_at((*above.split(".")[:-1], name))
        if inner is not None:
            yield from _keys_below(inner, f"{above}{name}.")


def _shown(value: object) -> str:
    """A value as a message shows it, cut where it is long."""
    try:
        return shortened(repr(value))
    except (RecursionError, ValueError):  # deep nesting, or thousands of digits
        return "a value that is too long"


def _must_be(message: str) -> str:
    if "valid dictionary" in message:
        return "must be a table"
    return message.replace("Input should be", "must be")


def _model_at(path: tuple[str, ...]) -> type[BaseModel] | None:
    model: type[BaseModel] | None = Profile
    for part in path:
        field = model.model_fields.get(part) if model else None
        kinds = (field.annotation, *get_args(field.annotation)) if field else ()
        inner = [kind for kind in kinds if isinstance(kind, type) and issubclass(kind, BaseModel)]
        model = inner[0] if inner else None
    return model


def _allowed(owner: type[BaseModel], key: str) -> str:
    """The allowed values in words, from the constraints of the field; "" where it has none."""
    field = owner.model_fields.get(key)
    if field is None:
        return ""
    if field.description:
        return field.description
    low = [mark.ge for mark in field.metadata if hasattr(mark, "ge")]
    high = [mark.le for mark in field.metadata if hasattr(mark, "le")]
    return f"must be a number between {low[0]:g} and {high[0]:g}" if low and high else ""
