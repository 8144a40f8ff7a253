"""Resolves the colours and the paint of a 3MF's triangles to styles, numbered through the file.

Source: 3MF core specification 1.3, section 4.1.3 (pid, p1); materials extension 1.2.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from printprep.threemf.parse import ParsedModel, ParsedObject, Properties
from printprep.types import PLAIN, Material, Paint, ReadNote, Style

if TYPE_CHECKING:
    from printprep.arrays import Int

_KEEP = "Colour each triangle with one material, or paint the part again."


class StyleBook:
    """The styles of a file, in the order in which they are met; number 0 is ``PLAIN``."""

    def __init__(self) -> None:
        self._numbers: dict[Style, int] = {PLAIN: 0}
        self._textures = self._gradients = self._too_many = self._mirrored = False

    def labels(self, model: ParsedModel, found: ParsedObject, count: int) -> Int:
        """(count,), the style of each triangle of an object."""
        self._too_many = self._too_many or model.styles_lost
        numbers = [
            self._number(self._style(model, found.own, style)) for style in found.styles
        ]  # in the order of their numbers
        own = np.zeros(count, dtype=np.int32)
        own[: len(found.labels)] = found.labels
        resolved: Int = np.array(numbers, dtype=np.int64)[own]
        return resolved

    def paint(self, labels: Sequence[Int]) -> Paint | None:
        """The paint of meshes with these labels, (m,) each; None where nothing is painted."""
        together = np.concatenate(labels)
        return Paint(tuple(self._numbers), together) if together.any() else None

    def whole(self, labels: Int) -> Int:
        """The labels (m,) without codes that split a triangle, which a mirror image turns over."""
        numbers = np.array([self._number(style.whole) for style in list(self._numbers)])
        self._mirrored = self._mirrored or bool((numbers[labels] != labels).any())
        found: Int = numbers[labels]
        return found

    def notes(self) -> list[ReadNote]:
        """What the triangles have that no style can hold."""
        notes = []
        if self._textures:
            message = "The textures or mixed materials of the file are not kept on the part."
            notes.append(ReadNote("colours-lost", message, _KEEP))
        if self._gradients:
            message = (
                "Triangles of the file have a colour for each corner; the first one is kept for "
                "the whole triangle."
            )
            notes.append(ReadNote("colours-lost", message, _KEEP))
        if self._mirrored:
            message = "Paint that splits triangles is lost where the file mirrors an object."
            notes.append(ReadNote("colours-lost", message, "Paint the part again."))
        if self._too_many:
            message = "The file has more kinds of paint than are kept; the rest is lost."
            notes.append(ReadNote("colours-lost", message, "Paint the part again."))
        return notes

    def _number(self, style: Style) -> int:
        return self._numbers.setdefault(style, len(self._numbers))

    def _style(self, model: ParsedModel, own: Properties, found: Properties) -> Style:
        group, indices = (found.group, found.indices) if found.indices else (None, ())
        if not indices:
            group, indices = own.group, own.indices
        elif group is None:
            group = own.group
        if len(set(indices)) > 1:
            self._gradients = True
        return Style(self._material(model, group, indices), found.strokes)

    def _material(
        self, model: ParsedModel, group: str | None, indices: tuple[str, ...]
    ) -> Material | None:
        if group is None or group not in model.materials:
            return None
        materials = model.materials[group]
        if materials is None:
            self._textures = True
            return None
        index = indices[0] if indices else "0"
        if not (index.isascii() and index.isdecimal() and len(index) < 9):
            return None
        return materials[int(index)] if int(index) < len(materials) else None
