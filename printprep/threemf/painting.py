"""Writes colours and paint into a 3MF: a group of base materials, and attributes of triangles.

Source: 3MF core specification 1.3, sections 4.1.2 and 5.1; PrusaSlicer's and BambuStudio's
src/libslic3r/Format for the attributes of paint.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from printprep.threemf.xml_text import escape
from printprep.types import Material, Style

if TYPE_CHECKING:
    from printprep.threemf.item import Item, Volume

PRUSA_STROKES: Mapping[str, str] = MappingProxyType(
    {
        "colour": "slic3rpe:mmu_segmentation",
        "supports": "slic3rpe:custom_supports",
        "seam": "slic3rpe:custom_seam",
        "fuzzy": "slic3rpe:fuzzy_skin",
    }
)
ORCA_STROKES: Mapping[str, str] = MappingProxyType(
    {
        "colour": "paint_color",
        "supports": "paint_supports",
        "seam": "paint_seam",
        "fuzzy": "paint_fuzzy_skin",
    }
)
_VERSIONS = {
    "slic3rpe:mmu_segmentation": "slic3rpe:MmPaintingVersion",
    "slic3rpe:custom_supports": "slic3rpe:FdmSupportsPaintingVersion",
    "slic3rpe:custom_seam": "slic3rpe:SeamPaintingVersion",
}


def materials_of(items: Sequence[Item]) -> tuple[Material, ...]:
    """The materials of all volumes, in the order in which they are met."""
    found = dict.fromkeys(
        style.material
        for item in items
        for volume in item.volumes
        if volume.paint is not None
        for style in volume.paint.styles
        if style.material is not None
    )
    return tuple(found)


def material_lines(materials: Sequence[Material], group: int) -> list[bytes]:
    """The group of base materials, nothing where there are none."""
    if not materials:
        return []
    bases = "".join(
        f'   <base name="{escape(material.name) or "colour"}" displaycolor="{material.colour}"/>\n'
        for material in materials
    )
    return [f'  <basematerials id="{group}">\n{bases}  </basematerials>\n'.encode()]


def painting_versions(items: Sequence[Item], strokes: Mapping[str, str]) -> list[bytes]:
    """PrusaSlicer's mark of the version of each kind of paint that is written."""
    kinds = {
        kind
        for item in items
        for volume in item.volumes
        if volume.paint is not None
        for style in volume.paint.styles
        for kind, _ in style.strokes
    }
    names = sorted(_VERSIONS[strokes[k]] for k in kinds if strokes.get(k) in _VERSIONS)
    return [f' <metadata name="{name}">1</metadata>\n'.encode() for name in names]


class Painter:
    """Writes styles as attributes.

    materials : those of the group with the id ``group``;  strokes : attribute by kind of paint.
    """

    def __init__(
        self, materials: Sequence[Material], group: int, strokes: Mapping[str, str]
    ) -> None:
        self._index = {material: index for index, material in enumerate(materials)}
        self._group, self._strokes = group, strokes

    def default(self, item: Item) -> str:
        """The attributes of an object: the material of most of its triangles, as its default."""
        counts: dict[Material, int] = {}
        for volume in item.volumes:
            if volume.paint is None:
                continue
            numbers = np.bincount(volume.paint.labels, minlength=len(volume.paint.styles))
            for style, number in zip(volume.paint.styles, numbers.tolist(), strict=True):
                if style.material is not None:
                    counts[style.material] = counts.get(style.material, 0) + number
        if not counts:
            return ""
        most = max(counts, key=lambda material: counts[material])
        return f' pid="{self._group}" pindex="{self._index[most]}"'

    def attributes(self, volume: Volume) -> list[bytes] | None:
        """What each triangle of a volume carries, None for nothing in any."""
        if volume.paint is None:
            return None
        texts = [self._text(style) for style in volume.paint.styles]
        return [texts[label] for label in volume.paint.labels.tolist()]

    def _text(self, style: Style) -> bytes:
        text = ""
        if style.material is not None:
            text += f' pid="{self._group}" p1="{self._index[style.material]}"'
        for kind, code in style.strokes:
            if kind in self._strokes:
                text += f' {self._strokes[kind]}="{code}"'
        return text.encode()
