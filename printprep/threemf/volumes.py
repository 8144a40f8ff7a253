"""Finds the parts of an object that a slicer does not print, by the slicer's config in the 3MF.

PrusaSlicer and SuperSlicer keep modifiers as ranges of triangles in the one mesh of an object;
BambuStudio and OrcaSlicer keep each as a component.  A negative volume is subtracted from the
object, which printprep does not do, so a file with one is refused.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from printprep.errors import InputError
from printprep.threemf.archive import Archive
from printprep.threemf.package import CONFIG_PART
from printprep.threemf.parse import Element, parse_elements

_BAMBU_PART = "Metadata/model_settings.config"
_SOLID = ("ModelPart", "normal_part", "")
_NEGATIVE = ("NegativeVolume", "negative_part")


@dataclass(frozen=True)
class Unprinted:
    """The parts of the root model's objects that are not printed.

    triangles : object id → inclusive ranges of its triangles;
    components : pairs (id of the object on the bed, id of the component's object).
    """

    triangles: Mapping[str, tuple[tuple[int, int], ...]]
    components: frozenset[tuple[str, str]]


def read_unprinted(archive: Archive) -> Unprinted:
    """Read both kinds of config, if the archive has them.  Raises InputError for a broken one."""
    triangles: dict[str, list[tuple[int, int]]] = {}
    for object_id, volume, settings in _children(archive, CONFIG_PART, "volume"):
        kind = settings.get("volume_type", "ParameterModifier" if "modifier" in settings else "")
        if _left_out(archive, kind, settings.get("name", "")):
            try:
                span = int(volume["firstid"]), int(volume["lastid"])
            except (KeyError, ValueError) as error:
                raise InputError(
                    f"{archive.name}: {CONFIG_PART} has a volume without a range of triangles.",
                    "Export the model again.",
                ) from error
            triangles.setdefault(object_id, []).append(span)
    components = set()
    for object_id, part, settings in _children(archive, _BAMBU_PART, "part"):
        if _left_out(archive, part.get("subtype", ""), settings.get("name", "")):
            components.add((object_id, part.get("id", "")))
    return Unprinted(
        {object_id: tuple(spans) for object_id, spans in triangles.items()}, frozenset(components)
    )


def _left_out(archive: Archive, kind: str, name: str) -> bool:
    if kind in _NEGATIVE:
        raise InputError(
            f"{archive.name} has a negative volume, {name!r}, which printprep cannot subtract.",
            "Subtract it in a modelling program and export the result.",
        )
    return kind not in _SOLID


def _children(
    archive: Archive, part: str, child: str
) -> list[tuple[str, dict[str, str], dict[str, str]]]:
    """(object id, attributes, metadata by key) of each `child` element of each object."""
    if part not in archive:
        return []
    elements: list[Element] = parse_elements(archive.read(part), f"{archive.name}: {part}")
    found: list[tuple[str, dict[str, str], dict[str, str]]] = []
    object_id = ""
    inside: dict[str, str] | None = None
    for depth, name, attributes in elements:
        if depth == 1:
            object_id, inside = attributes.get("id", ""), None
        elif depth == 2:
            inside = {} if name == child else None
            if inside is not None:
                found.append((object_id, attributes, inside))
        elif inside is not None and name == "metadata":
            inside[attributes.get("key", "")] = attributes.get("value", "")
    return found
