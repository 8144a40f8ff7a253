"""The TOML text of an imported profile: every key with where it is from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import tomlkit
from tomlkit.items import Item, Table

from printprep.profiles import Profile


def profile_text(profile: Profile, origins: Mapping[str, str], rest: str, heading: str) -> str:
    """TOML of a profile.

    origins : dotted key → where its value is from;  rest : where all others are from;
    heading : the comment at the top.
    """
    document = tomlkit.document()
    document.add(tomlkit.comment(heading))
    document.add(tomlkit.comment("Lengths are mm, densities g/cm³, angles degrees."))
    document.add(tomlkit.nl())
    data = profile.model_dump(mode="json", exclude_none=True, exclude={"name"})
    _fill(document, data, "", origins, rest)
    return tomlkit.dumps(document)


def _fill(
    table: tomlkit.TOMLDocument | Table,
    data: Mapping[str, Any],
    above: str,
    origins: Mapping[str, str],
    rest: str,
) -> None:
    """Put values and then tables into a table, so that no value ends up in a table before it."""
    for key, value in data.items():
        if not isinstance(value, Mapping):
            item: Item = tomlkit.item(value)
            item.comment(origins.get(above + key, rest))
            table.add(key, item)
    for key, value in data.items():
        if isinstance(value, Mapping) and value:
            inner = tomlkit.table()
            _fill(inner, value, f"{above}{key}.", origins, rest)
            table.add(key, inner)
