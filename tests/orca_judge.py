"""Judges the structure of a 3MF by the rules of OrcaSlicer's and BambuStudio's own parser.

The programs cannot run here.  This follows what their src/libslic3r/Format/bbs_3mf.cpp does with a
file, with a plain XML parser and no code of printprep, and refuses what makes it fail or misplace a
volume.
"""

from __future__ import annotations

import io
import xml.etree.ElementTree as ElementTree
import zipfile
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
# ModelVolume::type_from_string in Model.cpp; any other text becomes a part of the model.
SUBTYPES = {
    "normal_part",
    "negative_part",
    "modifier_part",
    "support_blocker",
    "support_enforcer",
}
# Keys and values of PrintObjectConfig and PrintRegionConfig that both programs know.
PATTERNS = {"monotonic", "gyroid", "lightning", "grid", "cubic", "honeycomb", "concentric"}
KEYS = {
    "wall_loops": str.isdecimal,
    "top_shell_layers": str.isdecimal,
    "bottom_shell_layers": str.isdecimal,
    "sparse_infill_density": lambda text: text.endswith("%") and 0 <= float(text[:-1]) <= 100,
    "sparse_infill_pattern": PATTERNS.__contains__,
    "support_on_build_plate_only": ("0", "1").__contains__,
    "elefant_foot_compensation": lambda text: float(text) >= 0,
    "slicing_mode": ("regular", "even_odd", "close_holes").__contains__,
}


@dataclass(frozen=True, eq=False)
class OrcaVolume:
    """A volume in its place on the bed: vertices (n, 3) mm, faces (m, 3)."""

    name: str
    subtype: str
    settings: dict[str, str]
    vertices: NDArray[np.float64]
    faces: NDArray[np.int64]


@dataclass(frozen=True)
class OrcaObject:
    name: str
    settings: dict[str, str]
    volumes: list[OrcaVolume]


def read_as_orca(content: bytes) -> list[OrcaObject]:
    """The objects that the slicer makes of a file, each with its volumes."""
    archive = zipfile.ZipFile(io.BytesIO(content))
    root = ElementTree.fromstring(archive.read(_start_part(archive)))
    config = ElementTree.fromstring(archive.read("Metadata/model_settings.config"))
    assert root.get("unit") == "millimeter"
    objects: dict[str, ElementTree.Element] = {}
    for found in root.iter(f"{_CORE}object"):
        assert found.get("type") in ("model", "other")
        assert found.get("id") not in objects, "Found object with duplicate id"
        objects[found.get("id", "")] = found
        for component in found.iter(f"{_CORE}component"):
            assert component.get("objectid") in objects, "a component before its object"
    metadata: dict[str, ElementTree.Element] = {}
    for entry in config.findall("object"):
        assert entry.get("id") not in metadata, "Duplicated object id in model_settings.config"
        metadata[entry.get("id", "")] = entry
    items = root.findall(f"{_CORE}build/{_CORE}item")
    assert {item.get("objectid") for item in items} == set(metadata)
    return [_object(item, objects, metadata[item.get("objectid", "")]) for item in items]


def _start_part(archive: zipfile.ZipFile) -> str:
    for relation in ElementTree.fromstring(archive.read("_rels/.rels")):
        kind = relation.get("Type", "")
        if kind.startswith("http://schemas.microsoft.com/3dmanufacturing/"):
            assert kind.endswith("3dmodel")
            return relation.get("Target", "").removeprefix("/")
    raise AssertionError("no start part")


def _object(
    item: ElementTree.Element, objects: dict[str, ElementTree.Element], entry: ElementTree.Element
) -> OrcaObject:
    # Some versions bake an item's transform into the first volume alone.
    assert item.get("transform") is None
    parts = {part.get("id"): part for part in entry.findall("part")}
    components = objects[item.get("objectid", "")].findall(f"{_CORE}components/{_CORE}component")
    assert [part.get("objectid") for part in components] == list(parts), "a part without a mesh"
    volumes = []
    for component in components:
        part, found = parts[component.get("objectid")], objects[component.get("objectid", "")]
        # A range of triangles would make it a volume of an older layout, which is not read.
        assert part.get("lastid") is None
        assert part.get("subtype") in SUBTYPES
        name, settings = _settings(part)
        matrix = np.array((component.get("transform") or "").split(), float).reshape(4, 3)
        points = [[float(v.get(axis, "")) for axis in "xyz"] for v in found.iter(f"{_CORE}vertex")]
        corners = [
            [int(t.get(corner, "")) for corner in ("v1", "v2", "v3")]
            for t in found.iter(f"{_CORE}triangle")
        ]
        assert corners, "found no triangles in the object"
        vertices = np.array(points) @ matrix[:3] + matrix[3]
        volumes.append(
            OrcaVolume(name, part.get("subtype", ""), settings, vertices, np.array(corners))
        )
    return OrcaObject(*_settings(entry), volumes)


def _settings(entry: ElementTree.Element) -> tuple[str, dict[str, str]]:
    found = {one.get("key", ""): one.get("value", "") for one in entry.findall("metadata")}
    name = found.pop("name")
    for key, value in found.items():
        assert KEYS[key](value), (key, value)
    return name, found
