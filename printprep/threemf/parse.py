"""Parses the XML parts of a 3MF as a stream into flat lists: no tree, no entities, no network.

Elements count by their local name in the namespace of the root, whatever that is: drafts and tests
of the standard use several.  Elements of extensions are skipped with their content, but for the
colours of the materials extension.

Source: 3MF core specification 1.3; production extension 1.1 (the path attribute); materials and
properties extension 1.2.
"""

from __future__ import annotations

import io
import math
import re
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import IO, Any
from xml.etree.ElementTree import ParseError

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from printprep.errors import InputError
from printprep.types import Material
from printprep.wording import printable, shortened

_PRODUCTION = "{http://schemas.microsoft.com/3dmanufacturing/production/2015/06}path"
_MATERIALS = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"
_SLIC3R = "{http://schemas.slic3r.org/3mf/2017/06}"
_STROKES = {
    f"{_SLIC3R}mmu_segmentation": "colour",
    f"{_SLIC3R}custom_supports": "supports",
    f"{_SLIC3R}custom_seam": "seam",
    f"{_SLIC3R}fuzzy_skin": "fuzzy",
    "paint_color": "colour",
    "paint_supports": "supports",
    "paint_seam": "seam",
    "paint_fuzzy_skin": "fuzzy",
}
_CODE = re.compile(r"[0-9A-Fa-f]+")
_COLOUR = re.compile(r"#(?:[0-9A-Fa-f]{6}|[0-9A-Fa-f]{8})")
# Required extensions that do not change the triangles; any other may redefine the shape.
_HARMLESS = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.slic3r.org/3mf/2017/06",
    "http://schemas.bambulab.com/package/2021",
}
# The six words of the standard, and what programs and people write for them.
_TO_MM = {
    **dict.fromkeys(("micron", "microns", "um", "µm", "micrometer", "micrometre"), 1e-3),
    **dict.fromkeys(("", "mm", "millimeter", "millimeters", "millimetre", "millimetres"), 1.0),
    **dict.fromkeys(("cm", "centimeter", "centimeters", "centimetre", "centimetres"), 10.0),
    **dict.fromkeys(("in", "inch", "inches"), 25.4),
    **dict.fromkeys(("ft", "foot", "feet"), 304.8),
    **dict.fromkeys(("m", "meter", "meters", "metre", "metres"), 1000.0),
}
_CHUNK_BYTES = 1 << 20
# More than any model has; each stops a file that costs far more than its size.
_DEPTH_MAX = 128
_OBJECTS_MAX = 100_000
_REFERENCES_MAX = 200_000
_MATERIALS_MAX = 100_000
_STYLES_MAX = 500_000
_VERTICES_MAX = 10_000_000
_TRIANGLES_MAX = 5_000_000
_ELEMENTS_MAX = 200_000  # of a slicer's config


Element = tuple[int, str, dict[str, str]]
"""(depth, local name, attributes)"""


@dataclass(frozen=True, eq=False)
class ObjectReference:
    """An object with its place, as a component or an item of the build names it.

    part : model part that holds the object, None for the same one;  transform : (4, 3) float64 in
    the file's unit, for row vectors: point · transform[:3] + transform[3].
    printable : False for an item of the build that is switched off.
    """

    object_id: str
    part: str | None
    transform: np.ndarray[Any, np.dtype[np.float64]]
    printable: bool = True


@dataclass(frozen=True)
class Properties:
    """What one <triangle> says beside its corners, or an <object> for all of its triangles.

    group : id of its materials, None for the object's;  indices : those it uses, one for each
    corner that names one;  strokes : as in :class:`printprep.types.Style`.
    """

    group: str | None = None
    indices: tuple[str, ...] = ()
    strokes: tuple[tuple[str, str], ...] = ()


NO_PROPERTIES = Properties()


@dataclass(eq=False)
class ParsedObject:
    """One <object>: coordinates (3n,) in the file's unit and vertex indices (3m,), both flat.

    own : the object's own properties;  styles : those of its triangles, numbered, the first without
    any;  labels : the number for each triangle, shorter where the last ones have none.
    """

    kind: str
    name: str
    own: Properties = NO_PROPERTIES
    styles: dict[Properties, int] = field(default_factory=lambda: {NO_PROPERTIES: 0})
    labels: array[int] = field(default_factory=lambda: array("i"))
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    indices: array[int] = field(default_factory=lambda: array("q"))
    components: list[ObjectReference] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class ParsedModel:
    """One model part: its unit, objects by id, and the items of the build.

    unit : as the file writes it;  unit_mm : its length, None where it is no unit;
    materials : those of each group, None for a group that holds no plain colours (textures);
    styles_lost : whether its paint has more styles than are kept.
    """

    unit: str
    unit_mm: float | None
    objects: dict[str, ParsedObject]
    items: list[ObjectReference]
    materials: dict[str, list[Material | None] | None]
    styles_lost: bool


class _Model:
    """Target of the XML parser; every error is a ValueError that names the element."""

    def __init__(self) -> None:
        self.unit = "millimeter"
        self.objects: dict[str, ParsedObject] = {}
        self.items: list[ObjectReference] = []
        self.materials: dict[str, list[Material | None] | None] = {}
        self._group: list[Material | None] | None = None
        self._namespaces: dict[str, str] = {}
        self._core: str | None = None
        self._vertex = ""
        self._skipping = self._depth = self._references = self._styles = self._material_count = 0
        self._styles_lost = False
        self._object: ParsedObject | None = None

    def start_ns(self, prefix: str, uri: str) -> None:
        self._namespaces.setdefault(prefix, uri)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        self._depth += 1
        if self._depth > _DEPTH_MAX:
            raise ValueError(f"its elements are nested deeper than {_DEPTH_MAX}")
        if self._core is None:
            self._root(tag, attributes)
        elif tag == self._vertex and self._object is not None and not self._skipping:
            # Most elements are this one; it is read without another call.
            try:
                x, y, z = attributes["x"], attributes["y"], attributes["z"]
                numbers = (float(x), float(y), float(z))
                whole = x + y + z
                if "_" in whole or not whole.isascii():  # Python would take 2_0 for 20
                    raise ValueError
            except (KeyError, ValueError):
                count = len(self._object.coordinates) // 3
                raise _no_numbers("vertex", count, attributes, ("x", "y", "z")) from None
            self._object.coordinates.extend(numbers)
        elif self._skipping or not tag.startswith(self._core):
            self._skipping += 1
            if tag.startswith(_MATERIALS):
                self._colour(tag[len(_MATERIALS) :], attributes)
        else:
            name = tag[len(self._core) :]
            if name == "triangle":
                self._triangle(attributes)
            elif name == "vertex":
                raise ValueError("<vertex> stands outside an object")
            elif name == "object":
                self._start_object(attributes)
            elif name == "component":
                if self._object is None:
                    raise ValueError("<component> stands outside an object")
                self._object.components.append(self._reference("component", attributes))
            elif name == "item":
                self.items.append(self._reference("item", attributes))
            elif name == "basematerials":
                self._start_group(attributes)
            elif name == "base":
                self._add_material(attributes.get("name", ""), attributes.get("displaycolor", ""))

    def end(self, tag: str) -> None:
        self._depth -= 1
        if self._skipping:
            self._skipping -= 1
        elif self._core is not None and tag == f"{self._core}object":
            self._object = None

    def check(self) -> None:
        """Raise ValueError where there is more so far than any model has."""
        vertices = sum(len(item.coordinates) for item in self.objects.values()) // 3
        triangles = sum(len(item.indices) for item in self.objects.values()) // 3
        if triangles > _TRIANGLES_MAX or vertices > _VERTICES_MAX:
            raise ValueError(
                f"it has more than {_TRIANGLES_MAX} triangles or {_VERTICES_MAX} vertices"
            )

    def close(self) -> ParsedModel:
        unit_mm = _TO_MM.get(self.unit.strip().lower())
        return ParsedModel(
            self.unit, unit_mm, self.objects, self.items, self.materials, self._styles_lost
        )

    def _root(self, tag: str, attributes: dict[str, str]) -> None:
        self._core = tag[: tag.rfind("}") + 1]
        if tag[len(self._core) :] != "model":
            raise ValueError("the root element is not <model>")
        self._vertex = f"{self._core}vertex"
        self.unit = attributes.get("unit", self.unit)
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._namespaces.get(prefix, prefix)
            if uri not in _HARMLESS:
                raise ValueError(
                    f"the shape needs an extension that is not supported ({shortened(uri, 120)})"
                )

    def _start_object(self, attributes: dict[str, str]) -> None:
        number = _attribute("object", attributes, "id")
        if number in self.objects:
            raise ValueError(f"two objects have the id {shortened(number)}")
        if len(self.objects) >= _OBJECTS_MAX:
            raise ValueError(f"it has more than {_OBJECTS_MAX} objects")
        index = attributes.get("pindex")
        self._object = ParsedObject(
            attributes.get("type", "model"),
            attributes.get("name", ""),
            Properties(attributes.get("pid"), () if index is None else (index,)),
        )
        self.objects[number] = self._object

    def _reference(self, element: str, attributes: dict[str, str]) -> ObjectReference:
        self._references += 1
        if self._references > _REFERENCES_MAX:
            raise ValueError(f"it has more than {_REFERENCES_MAX} items and components")
        return _reference(element, attributes)

    def _triangle(self, attributes: dict[str, str]) -> None:
        owner = self._object
        if owner is None:
            raise ValueError("<triangle> stands outside an object")
        try:
            a, b, c = attributes["v1"], attributes["v2"], attributes["v3"]
            whole = a + b + c
            if "_" in whole or not whole.isascii():
                raise ValueError
            owner.indices.extend((int(a), int(b), int(c)))
        except (KeyError, ValueError, OverflowError):
            count = len(owner.indices) // 3
            raise _no_numbers("triangle", count, attributes, ("v1", "v2", "v3")) from None
        if len(attributes) > 3:
            self._properties(owner, attributes)

    def _properties(self, owner: ParsedObject, attributes: dict[str, str]) -> None:
        """Keep the colours and the paint of the triangle that was read last."""
        strokes = sorted(
            (_STROKES[key], code.upper())
            for key, code in attributes.items()
            if key in _STROKES and _CODE.fullmatch(code)
        )
        indices = tuple(attributes[key] for key in ("p1", "p2", "p3") if key in attributes)
        found = Properties(attributes.get("pid"), indices, tuple(dict(strokes).items()))
        if found not in owner.styles:
            self._styles += 1
            if self._styles > _STYLES_MAX:
                self._styles_lost = True
                return
        number = owner.styles.setdefault(found, len(owner.styles))
        if number:
            missing = len(owner.indices) // 3 - 1 - len(owner.labels)
            owner.labels.extend([0] * missing)
            owner.labels.append(number)

    def _start_group(self, attributes: dict[str, str]) -> None:
        self._group = []
        self.materials[attributes.get("id", "")] = self._group

    def _colour(self, name: str, attributes: dict[str, str]) -> None:
        """A group of the materials extension, or a colour in one."""
        if name == "colorgroup":
            self._start_group(attributes)
        elif name == "color":
            self._add_material("", attributes.get("color", ""))
        elif name in ("texture2dgroup", "compositematerials", "multiproperties"):
            self._group = None
            self.materials[attributes.get("id", "")] = None

    def _add_material(self, name: str, colour: str) -> None:
        self._material_count += 1
        if self._material_count > _MATERIALS_MAX:
            raise ValueError(f"it has more than {_MATERIALS_MAX} materials")
        if self._group is not None:
            right = _COLOUR.fullmatch(colour) is not None
            self._group.append(Material(name or colour.upper(), colour.upper()) if right else None)


def _no_numbers(
    name: str, count: int, attributes: dict[str, str], keys: tuple[str, str, str]
) -> ValueError:
    said = shortened(" ".join(attributes.get(key, "?")[:80] for key in keys))
    return ValueError(f"{name} {count} is not three numbers: {said}")


def parse_model(stream: IO[bytes], label: str) -> ParsedModel:
    """Parse one model part.  Raises InputError that begins with `label` (file and part)."""
    parsed: ParsedModel = _feed(stream, _Model(), label)
    return parsed


def parse_elements(content: bytes, label: str) -> list[Element]:
    """All elements of a small part, in document order."""

    class _Flat:
        def __init__(self) -> None:
            self.found: list[Element] = []
            self.depth = 0

        def start(self, tag: str, attributes: dict[str, str]) -> None:
            if len(self.found) >= _ELEMENTS_MAX or self.depth >= _DEPTH_MAX:
                raise ValueError(
                    f"it has more than {_ELEMENTS_MAX} elements, or some nested deeper than "
                    f"{_DEPTH_MAX}"
                )
            self.found.append((self.depth, tag.rpartition("}")[2], attributes))
            self.depth += 1

        def end(self, tag: str) -> None:
            self.depth -= 1

        def check(self) -> None:
            """Nothing to check: the part is small."""

        def close(self) -> list[Element]:
            return self.found

    elements: list[Element] = _feed(io.BytesIO(content), _Flat(), label)
    return elements


def _feed(stream: IO[bytes], target: Any, label: str) -> Any:
    parser = DefusedXMLParser(target=target, forbid_dtd=True)  # 3MF forbids DTDs itself
    try:
        for chunk in _chunks(stream):
            parser.feed(chunk)
            target.check()
        return parser.close()
    except DefusedXmlException as error:
        raise InputError(
            f"{label} holds a document type or entities, which a 3MF must not.",
            "Export the model again, from another program if possible.",
        ) from error
    except (ParseError, ValueError, LookupError) as error:
        raise InputError(
            f"{label}: {printable(str(error)).rstrip('.')}.", "Export the model again."
        ) from error


def _chunks(stream: IO[bytes]) -> Iterator[bytes]:
    while chunk := stream.read(_CHUNK_BYTES):
        yield chunk


def _attribute(element: str, attributes: dict[str, str], key: str) -> str:
    if key not in attributes:
        raise ValueError(f"<{element}> has no {key}")
    return attributes[key].strip()


def _reference(element: str, attributes: dict[str, str]) -> ObjectReference:
    text = attributes.get("transform", "1 0 0 0 1 0 0 0 1 0 0 0")
    try:
        plain = text.isascii() and "_" not in text  # Python would take 2_0 for 20
        numbers = [float(word) for word in text.split(None, 12)] if plain else []
    except ValueError:
        numbers = []
    if len(numbers) != 12 or not all(math.isfinite(number) for number in numbers):
        raise ValueError(f"the transform of <{element}> is not twelve numbers: {shortened(text)}")
    return ObjectReference(
        _attribute(element, attributes, "objectid"),
        attributes.get(_PRODUCTION),
        np.array(numbers, dtype=np.float64).reshape(4, 3),
        attributes.get("printable", "1") not in ("0", "false"),
    )
