"""Parses the XML parts of a 3MF as a stream into flat lists: no tree, no entities, no network.

Elements count by their local name in the namespace of the root, whatever that is: drafts and tests
of the standard use several.  Elements of extensions are skipped with their content.

Source: 3MF core specification 1.3; production extension 1.1 (the path attribute).
"""

from __future__ import annotations

import io
import math
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import IO, Any
from xml.etree.ElementTree import ParseError

import numpy as np
from defusedxml import DefusedXmlException
from defusedxml.ElementTree import DefusedXMLParser

from printprep.errors import InputError

_PRODUCTION = "{http://schemas.microsoft.com/3dmanufacturing/production/2015/06}path"
# Required extensions that do not change the triangles; any other may redefine the shape.
_HARMLESS = {
    "http://schemas.microsoft.com/3dmanufacturing/core/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02",
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06",
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07",
    "http://schemas.slic3r.org/3mf/2017/06",
    "http://schemas.bambulab.com/package/2021",
}
_TO_MM = {
    "micron": 1e-3,
    "millimeter": 1.0,
    "centimeter": 10.0,
    "inch": 25.4,
    "foot": 304.8,
    "meter": 1000.0,
}
_CHUNK_BYTES = 1 << 20


Element = tuple[int, str, dict[str, str]]
"""(depth, local name, attributes)"""


@dataclass(frozen=True, eq=False)
class ObjectReference:
    """An object with its place, as a component or an item of the build names it.

    part : model part that holds the object, None for the same one;  transform : (4, 3) float64 in
    the file's unit, for row vectors: point · transform[:3] + transform[3].
    """

    object_id: str
    part: str | None
    transform: np.ndarray[Any, np.dtype[np.float64]]


@dataclass(eq=False)
class ParsedObject:
    """One <object>: coordinates (3n,) in the file's unit and vertex indices (3m,), both flat."""

    kind: str
    name: str
    coordinates: array[float] = field(default_factory=lambda: array("d"))
    indices: array[int] = field(default_factory=lambda: array("q"))
    components: list[ObjectReference] = field(default_factory=list)


@dataclass(frozen=True, eq=False)
class ParsedModel:
    """One model part: its unit in mm, objects by id, and the printable items of the build."""

    unit_mm: float
    objects: dict[str, ParsedObject]
    items: list[ObjectReference]


class _Model:
    """Target of the XML parser; every error is a ValueError that names the element."""

    def __init__(self) -> None:
        self.unit_mm = 1.0
        self.objects: dict[str, ParsedObject] = {}
        self.items: list[ObjectReference] = []
        self._namespaces: dict[str, str] = {}
        self._core: str | None = None
        self._skipping = 0
        self._object: ParsedObject | None = None

    def start_ns(self, prefix: str, uri: str) -> None:
        self._namespaces.setdefault(prefix, uri)

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        if self._core is None:
            self._root(tag, attributes)
        elif self._skipping or not tag.startswith(self._core):
            self._skipping += 1
        else:
            name = tag[len(self._core) :]
            if name == "vertex" or name == "triangle":
                self._mesh(name, attributes)
            elif name == "object":
                self._start_object(attributes)
            elif name == "component":
                if self._object is None:
                    raise ValueError("<component> stands outside an object")
                self._object.components.append(_reference("component", attributes))
            elif name == "item" and attributes.get("printable", "1") not in ("0", "false"):
                self.items.append(_reference("item", attributes))

    def end(self, tag: str) -> None:
        if self._skipping:
            self._skipping -= 1
        elif self._core is not None and tag == f"{self._core}object":
            self._object = None

    def close(self) -> ParsedModel:
        return ParsedModel(self.unit_mm, self.objects, self.items)

    def _root(self, tag: str, attributes: dict[str, str]) -> None:
        self._core = tag[: tag.rfind("}") + 1]
        if tag[len(self._core) :] != "model":
            raise ValueError("the root element is not <model>")
        unit = attributes.get("unit", "millimeter")
        if unit not in _TO_MM:
            raise ValueError(f"the unit {unit!r} is none of {', '.join(_TO_MM)}")
        self.unit_mm = _TO_MM[unit]
        for prefix in attributes.get("requiredextensions", "").split():
            uri = self._namespaces.get(prefix, prefix)
            if uri not in _HARMLESS:
                raise ValueError(f"the shape needs an extension that is not supported ({uri})")

    def _start_object(self, attributes: dict[str, str]) -> None:
        number = _attribute("object", attributes, "id")
        if number in self.objects:
            raise ValueError(f"two objects have the id {number}")
        self._object = ParsedObject(attributes.get("type", "model"), attributes.get("name", ""))
        self.objects[number] = self._object

    def _mesh(self, name: str, attributes: dict[str, str]) -> None:
        owner = self._object
        if owner is None:
            raise ValueError(f"<{name}> stands outside an object")
        flat: array[float] | array[int]
        try:
            if name == "vertex":
                flat = owner.coordinates
                owner.coordinates.extend([float(attributes[key]) for key in ("x", "y", "z")])
            else:
                flat = owner.indices
                owner.indices.extend([int(attributes[key]) for key in ("v1", "v2", "v3")])
        except (KeyError, ValueError, OverflowError):
            count = len(flat) // 3
            raise ValueError(f"{name} {count} is not three numbers: {attributes}") from None


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
            self.found.append((self.depth, tag.rpartition("}")[2], attributes))
            self.depth += 1

        def end(self, tag: str) -> None:
            self.depth -= 1

        def close(self) -> list[Element]:
            return self.found

    elements: list[Element] = _feed(io.BytesIO(content), _Flat(), label)
    return elements


def _feed(stream: IO[bytes], target: Any, label: str) -> Any:
    parser = DefusedXMLParser(target=target, forbid_dtd=True)  # 3MF forbids DTDs itself
    try:
        for chunk in _chunks(stream):
            parser.feed(chunk)
        return parser.close()
    except DefusedXmlException as error:
        raise InputError(
            f"{label} holds a document type or entities, which a 3MF must not.",
            "Export the model again, from another program if possible.",
        ) from error
    except (ParseError, ValueError, LookupError) as error:
        raise InputError(f"{label}: {error}.", "Export the model again.") from error


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
        numbers = [float(word) for word in text.split()]
    except ValueError:
        numbers = []
    if len(numbers) != 12 or not all(math.isfinite(number) for number in numbers):
        raise ValueError(f"the transform of <{element}> is not twelve numbers: {text!r}")
    return ObjectReference(
        _attribute(element, attributes, "objectid"),
        attributes.get(_PRODUCTION),
        np.array(numbers, dtype=np.float64).reshape(4, 3),
    )
