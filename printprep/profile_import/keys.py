"""Profile keys from the settings of a slicer, each with where it is from."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass

from printprep.errors import InputError
from printprep.profile_import.dialects import AUTO_WIDTH
from printprep.profile_import.settings import Setting, Settings
from printprep.wording import shortened

Value = float | str | tuple[float, float, float]

_NUMBER = re.compile(r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,2})?")
_POINT = re.compile(r"([^x]+)x([^x]+)")
_POINTS_MAX = 10_000


@dataclass(frozen=True)
class Taken:
    """One key of a profile that the files have.  origin : the setting and its file, in words."""

    key: str
    value: Value
    origin: str


@dataclass(frozen=True)
class Missing:
    """One key of a profile that the files do not have.

    why : in words;  unresolved : it is there as a percentage of what is not.
    """

    key: str
    why: str
    unresolved: bool = False


def keys_of(settings: Settings) -> tuple[tuple[Taken, ...], tuple[Missing, ...]]:
    """What a profile takes from the settings, and what it misses in them.

    Raises InputError for a setting that is not what it must be, naming file and setting.
    """
    found = tuple(_Reader(settings).all())
    return (
        tuple(item for item in found if isinstance(item, Taken)),
        tuple(item for item in found if isinstance(item, Missing)),
    )


class _Reader:
    def __init__(self, settings: Settings) -> None:
        self._values = settings.values
        self._words = settings.dialect

    def all(self) -> Iterator[Taken | Missing]:
        words = self._words
        nozzle = self._number("printer.nozzle_mm", words.nozzle)
        layer = self._number("printer.layer_height_mm", words.layer_height)
        base = layer if words.percent_of == "layer" else nozzle
        yield nozzle
        yield self._line_width(nozzle, base)
        yield layer
        yield self._number("printer.first_layer_mm", words.first_layer, base)
        yield self._bed()
        yield self._number("printer.filament_mm", words.filament)
        yield self._material()
        yield self._number("material.density_g_cm3", words.density)

    def _line_width(self, nozzle: Taken | Missing, base: Taken | Missing) -> Taken | Missing:
        key = "printer.line_width_mm"
        widths = [self._number(key, name, base) for name in self._words.line_widths]
        for width in widths:
            if isinstance(width, Taken) or width.unresolved:
                return width
        automatic = any(self._items(name, ",") for name in self._words.line_widths)
        if automatic and isinstance(nozzle, Taken) and isinstance(nozzle.value, float):
            width_mm = round(AUTO_WIDTH * nozzle.value, 4)
            return Taken(key, width_mm, f"automatic in {self._words.program}, from {nozzle.origin}")
        return widths[-1]

    def _number(self, key: str, name: str, base: Taken | Missing | None = None) -> Taken | Missing:
        """A length or a density; 0 is none.  base : what a percentage is of."""
        items = self._items(name, ",")
        if not items:
            return Missing(key, f"{name} is in none of the files")
        setting, text = self._values[name], items[0]
        origin = f"{name} in {setting.file}{_first_of(items)}"
        number = _number(text.removesuffix("%"), name, setting)
        if text.endswith("%"):
            if base is None:
                raise _invalid(name, setting, text, "a number")
            if not isinstance(base, Taken) or not isinstance(base.value, float):
                why = f"{name} is {text} of what is in none of the files"
                return Missing(key, why, unresolved=True)
            return Taken(key, round(number / 100 * base.value, 4), f"{origin}: {text}")
        if number == 0:
            return Missing(key, f"{name} is 0 in {setting.file}")
        return Taken(key, number, origin)

    def _material(self) -> Taken | Missing:
        name = self._words.material
        items = self._items(name, ";")
        if not items:
            return Missing("material.name", f"{name} is in none of the files")
        origin = f"{name} in {self._values[name].file}{_first_of(items)}"
        return Taken("material.name", items[0], origin)

    def _bed(self) -> Taken | Missing:
        key, shape, height = "printer.bed_mm", self._words.bed_shape, self._words.height
        corners = self._items(shape, ",")
        top = self._number(key, height)
        if not corners:
            return Missing(key, f"{shape} is in none of the files")
        if isinstance(top, Missing):
            return top
        setting = self._values[shape]
        if len(corners) > _POINTS_MAX:
            raise _invalid(shape, setting, f"{len(corners)} points", "the outline of a bed")
        x, y = _largest_rectangle(
            [_point(text, shape, setting) for text in corners], shape, setting
        )
        assert isinstance(top.value, float)
        return Taken(key, (x, y, top.value), f"{shape} in {setting.file}, {top.origin}")

    def _items(self, name: str, separator: str) -> tuple[str, ...]:
        setting = self._values.get(name)
        return () if setting is None else setting.items(separator)


def _first_of(items: tuple[str, ...]) -> str:
    """That only the first extruder counts, where they differ."""
    return "" if len(set(items)) == 1 else f", the first of {shortened(', '.join(items))}"


def _number(text: str, name: str, setting: Setting) -> float:
    if not _NUMBER.fullmatch(text) or float(text) < 0:
        raise _invalid(name, setting, text, "a number")
    return float(text)


def _point(text: str, name: str, setting: Setting) -> tuple[float, float]:
    parts = _POINT.fullmatch(text)
    if not parts or not all(_NUMBER.fullmatch(part) for part in parts.groups()):
        raise _invalid(name, setting, text, "a point such as 250x210")
    return float(parts[1]), float(parts[2])


def _largest_rectangle(
    corners: list[tuple[float, float]], name: str, setting: Setting
) -> tuple[float, float]:
    """Sides of the largest rectangle in a bed, about its centre and in its proportions.

    corners : of the bed's convex outline, in order, mm.  A round bed has less room than its extent.
    """
    xs, ys = zip(*corners, strict=True)
    width, depth = max(xs) - min(xs), max(ys) - min(ys)
    middle_x, middle_y = (max(xs) + min(xs)) / 2, (max(ys) + min(ys)) / 2
    share = 1.0
    for (x1, y1), (x2, y2) in zip(corners, [*corners[1:], corners[0]], strict=True):
        normal_x, normal_y = y2 - y1, x1 - x2
        reach = abs(normal_x) * width / 2 + abs(normal_y) * depth / 2
        if reach > 0:
            distance = abs(normal_x * (x1 - middle_x) + normal_y * (y1 - middle_y))
            share = min(share, distance / reach)
    sides = (
        math.floor(1e3 * share * width + 1e-6) / 1e3,
        math.floor(1e3 * share * depth + 1e-6) / 1e3,
    )
    if not min(sides) > 0:
        raise _invalid(name, setting, f"{len(corners)} points", "the outline of a bed")
    return sides


def _invalid(name: str, setting: Setting, text: str, needed: str) -> InputError:
    return InputError(
        f"{setting.file}: {name} is {shortened(text)}, must be {needed}.",
        "Export the settings again.",
    )
