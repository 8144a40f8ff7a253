"""What a slicer's project in a 3MF says beside the meshes: what each volume is for, which objects
lie on which plate, which holes the slicer would drill.

PrusaSlicer and SuperSlicer keep the volumes of an object as ranges of triangles in one mesh;
BambuStudio and OrcaSlicer keep each as a component, and their objects on several plates.

Source: PrusaSlicer's src/libslic3r/Format/3mf.cpp, BambuStudio's src/libslic3r/Format/bbs_3mf.cpp.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from printprep.errors import InputError
from printprep.threemf.archive import Archive
from printprep.threemf.package import CONFIG_PART, ORCA_CONFIG_PART
from printprep.threemf.parse import Element, parse_elements

_PRINT_CONFIG_PART = "Metadata/Slic3r_PE.config"
_DRAIN_HOLES_PART = "Metadata/Slic3r_PE_sla_drain_holes.txt"
_SUPPORT_POINTS_PART = "Metadata/Slic3r_PE_sla_support_points.txt"

Purpose = Literal["part", "negative", "modifier", "blocker", "enforcer"]

_PURPOSES: Mapping[str, Purpose] = {
    "": "part",
    "ModelPart": "part",
    "normal_part": "part",
    "NegativeVolume": "negative",
    "negative_part": "negative",
    "ParameterModifier": "modifier",
    "modifier_part": "modifier",
    "SupportBlocker": "blocker",
    "support_blocker": "blocker",
    "SupportEnforcer": "enforcer",
    "support_enforcer": "enforcer",
}


@dataclass(frozen=True)
class VolumeRole:
    """What a volume of an object is for; a purpose that is not known counts as a modifier."""

    purpose: Purpose
    name: str


@dataclass(frozen=True)
class VolumeSpan:
    """A volume that is a range of an object's triangles, ``first`` to ``last``, both included."""

    role: VolumeRole
    first: int
    last: int


@dataclass(frozen=True)
class Plate:
    """One plate of a project.

    number : as the slicer shows it, from 1;  name : the user's, often "";
    members : (object id, which of the object's items in the build, from 0).
    """

    number: int
    name: str
    members: frozenset[tuple[str, int]]


@dataclass(frozen=True)
class Project:
    """What a project says; all of it is empty for a plain 3MF.

    spans : volumes by object id;  components : role by (id of the object on the bed, id of the
    component's object);  names : of objects, by id;  extruders : how many different ones print;
    ignored : what the slicer would do to the model, in words.
    """

    spans: Mapping[str, tuple[VolumeSpan, ...]]
    components: Mapping[tuple[str, str], VolumeRole]
    names: Mapping[str, str]
    plates: tuple[Plate, ...]
    extruders: int
    ignored: tuple[str, ...]


def read_project(archive: Archive) -> Project:
    """Read the configs of both families, as far as there are any.

    Raises InputError for a broken one.
    """
    spans: dict[str, list[VolumeSpan]] = {}
    components: dict[tuple[str, str], VolumeRole] = {}
    names: dict[str, str] = {}
    extruders: set[str] = set()
    hollowed = 0
    plates: list[Plate] = []
    for item in _items(archive, CONFIG_PART, "volume"):
        names.setdefault(item.object_id, item.settings.get("name", ""))
        hollowed += item.settings.get("hollowing_enable") == "1"
        for child in item.children:
            role = _role(child.settings, child.settings.get("volume_type"))
            span = _span(archive, child.attributes)
            spans.setdefault(item.object_id, []).append(VolumeSpan(role, *span))
            _add_extruder(extruders, role, child.settings, item.settings)
    for item in _items(archive, ORCA_CONFIG_PART, "part"):
        if item.element == "plate":
            plates.append(_plate(item, len(plates) + 1))
            continue
        names.setdefault(item.object_id, item.settings.get("name", ""))
        for child in item.children:
            role = _role(child.settings, child.attributes.get("subtype", ""))
            components[item.object_id, child.attributes.get("id", "")] = role
            _add_extruder(extruders, role, child.settings, item.settings)
    return Project(
        {object_id: tuple(found) for object_id, found in spans.items()},
        components,
        names,
        tuple(plate for plate in plates if plate.members),
        len(extruders),
        tuple(_ignored(archive, hollowed)),
    )


def _role(settings: Mapping[str, str], kind: str | None) -> VolumeRole:
    if kind is None:
        kind = "ParameterModifier" if settings.get("modifier") == "1" else ""
    return VolumeRole(_PURPOSES.get(kind, "modifier"), settings.get("name", ""))


def _span(archive: Archive, volume: Mapping[str, str]) -> tuple[int, int]:
    first, last = volume.get("firstid", ""), volume.get("lastid", "")
    if not (_is_index(first) and _is_index(last)):
        raise InputError(
            f"{archive.name}: {CONFIG_PART} has a volume without a range of triangles.",
            "Export the model again.",
        )
    return int(first), int(last)


def _is_index(text: str) -> bool:
    return text.isascii() and text.isdecimal() and len(text) <= 12


def _add_extruder(
    extruders: set[str], role: VolumeRole, own: Mapping[str, str], of_object: Mapping[str, str]
) -> None:
    if role.purpose == "part":
        found = own.get("extruder", "0")
        extruders.add(of_object.get("extruder", "1") if found == "0" else found)


def _plate(item: _Item, number: int) -> Plate:
    said = item.settings.get("plater_id", "")
    if _is_index(said):
        number = int(said)
    members = {
        (child.settings.get("object_id", ""), int(child.settings["instance_id"]))
        for child in item.children
        if _is_index(child.settings.get("instance_id", ""))
    }
    return Plate(number, item.settings.get("plater_name", ""), frozenset(members))


def _ignored(archive: Archive, hollowed: int) -> Iterator[str]:
    """What PrusaSlicer would do to a resin print."""
    if not hollowed and _PRINT_CONFIG_PART in archive:
        config = archive.read(_PRINT_CONFIG_PART)
        resin = b"printer_technology = SLA" in config
        hollowed = resin and b"hollowing_enable = 1" in config
    if hollowed:
        yield "its own hollowing"
    for part, what in (
        (_DRAIN_HOLES_PART, "its drain holes"),
        (_SUPPORT_POINTS_PART, "its support points"),
    ):
        if part in archive:
            lines = archive.read(part).decode("utf-8", "replace").splitlines()
            if any(line[:9] == "object_id" and line.partition("|")[2].strip() for line in lines):
                yield what


@dataclass(frozen=True)
class _Child:
    attributes: Mapping[str, str]
    settings: dict[str, str]


@dataclass(frozen=True)
class _Item:
    """An <object> or a <plate> of a config, with its volumes, parts or instances."""

    element: str
    object_id: str
    settings: dict[str, str]
    children: list[_Child]


def _items(archive: Archive, part: str, child: str) -> list[_Item]:
    """The objects and plates of a config, with the elements ``child`` of objects."""
    if part not in archive:
        return []
    elements: list[Element] = parse_elements(archive.read(part), f"{archive.name}: {part}")
    found: list[_Item] = []
    inside: dict[str, str] | None = None
    for depth, name, attributes in elements:
        if depth == 1:
            found.append(_Item(name, attributes.get("id", ""), {}, []))
            inside = None
        elif depth == 2 and name == "metadata":
            found[-1].settings[attributes.get("key", "")] = attributes.get("value", "")
        elif depth == 2:
            inside = {} if name in (child, "model_instance") else None
            if inside is not None:
                found[-1].children.append(_Child(attributes, inside))
        elif depth == 3 and inside is not None and name == "metadata":
            inside[attributes.get("key", "")] = attributes.get("value", "")
    return [item for item in found if item.element in ("object", "plate")]


def counts_of(roles: list[VolumeRole]) -> str:
    """Roles in words: "2 modifiers, a support blocker ('b')"."""
    words = {
        "part": "part",
        "negative": "negative volume",
        "modifier": "modifier",
        "blocker": "support blocker",
        "enforcer": "support enforcer",
    }
    counts = Counter(role.purpose for role in roles)
    return ", ".join(
        f"{number} {words[purpose]}{'' if number == 1 else 's'}"
        for purpose, number in sorted(counts.items())
    )
