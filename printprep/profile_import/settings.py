"""Settings of a slicer as they are in files: texts, and where each is from."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from printprep.profile_import.dialects import Dialect


@dataclass(frozen=True)
class Setting:
    """One setting as a file has it.

    value : the text, or several where the file has a list;  file : the name of the file.
    """

    value: str | tuple[str, ...]
    file: str

    def items(self, separator: str) -> tuple[str, ...]:
        """The values, one for each extruder or point; those without a meaning left out."""
        texts = self.value.split(separator) if isinstance(self.value, str) else self.value
        plain = (text.strip().strip('"') for text in texts)
        return tuple(text for text in plain if text and text != "nil")


@dataclass(frozen=True)
class Settings:
    """The settings of one print.

    absent : names of settings that these build on and that are in no file given.
    """

    dialect: Dialect
    values: Mapping[str, Setting]
    absent: tuple[str, ...] = ()
