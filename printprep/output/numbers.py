"""Numbers and points as JSON carries them: plain, finite, without meaningless digits."""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import fields, is_dataclass
from typing import Any


def number(value: float | None, digits: int = 6) -> float | None:
    """A value rounded to significant digits, never −0; None stays None."""
    return None if value is None else rounded(value, digits)


def rounded(value: float, digits: int = 6) -> float:
    """A value rounded to significant digits, never −0."""
    return float(f"{value:.{digits}g}") + 0.0


def place(point: Iterable[float], decimals: int = 3) -> tuple[float, float, float]:
    """A point (x, y, z) in mm, rounded to decimals, never −0."""
    x, y, z = (round(float(value), decimals) + 0.0 for value in point)
    return x, y, z


def plain(value: Any) -> Any:
    """A frozen value in JSON's types: dataclasses as objects, tuples as lists."""
    if is_dataclass(value) and not isinstance(value, type):
        return {item.name: plain(getattr(value, item.name)) for item in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(item) for key, item in value.items()}
    return [plain(item) for item in value] if isinstance(value, list | tuple) else value


def to_text(data: Mapping[str, Any]) -> str:
    """A JSON object as text, in ASCII so that every terminal and pipe accepts it.

    Raises ValueError for a number that is not finite.
    """
    return json.dumps(data, indent=2, allow_nan=False)
