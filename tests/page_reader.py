"""Reads a page as a program that is not ours would: its elements, its data, its meshes."""

from __future__ import annotations

import base64
import json
import zlib
from dataclasses import dataclass, field
from html.parser import HTMLParser

import numpy as np


@dataclass
class Element:
    tag: str
    attributes: dict[str, str | None]
    text: str = ""


@dataclass
class Reader(HTMLParser):
    """All elements of a page in order, each with the text directly in it."""

    elements: list[Element] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self._open: list[Element] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        element = Element(tag, dict(attrs))
        self.elements.append(element)
        if tag not in ("meta", "input", "img", "line", "circle"):
            self._open.append(element)

    def handle_endtag(self, tag: str) -> None:
        while self._open and self._open.pop().tag != tag:
            pass

    def handle_data(self, data: str) -> None:
        if self._open:
            self._open[-1].text += data

    def named(self, tag: str) -> list[Element]:
        return [element for element in self.elements if element.tag == tag]

    def by_id(self, name: str) -> Element:
        (found,) = (e for e in self.elements if e.attributes.get("id") == name)
        return found

    @property
    def text(self) -> str:
        skipped = ("script", "style")
        return " ".join(e.text.strip() for e in self.elements if e.tag not in skipped)


def read(page: bytes) -> Reader:
    reader = Reader()
    reader.feed(page.decode("utf-8"))
    return reader


def view_of(page: bytes) -> dict:
    return json.loads(read(page).by_id("view-data").text)


def geometry_of(page: bytes) -> str:
    return read(page).by_id("view-geometry").text


def meshes(directory: dict, text: str) -> dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]:
    """Name → vertices (n, 3) mm, triangles (m, 3), thickness (n,) mm or empty."""
    content, at = zlib.decompress(base64.b64decode(text)), 0
    found = {}
    for entry in directory["meshes"]:
        part = content[at : at + entry["bytes"]]
        at += entry["bytes"]
        found[entry["name"]] = _mesh(directory, entry, part)
    assert at == len(content)
    return found


def _mesh(directory, entry, part):
    n, at = entry["vertices"], 0

    def running() -> np.ndarray:
        nonlocal at
        planes = np.frombuffer(part, np.uint8, 3 * n, at).astype(np.int64).reshape(3, n)
        at += 3 * n
        return np.cumsum(_unzigzag(planes[0] | planes[1] << 8 | planes[2] << 16))

    axes = [running() for _ in range(3)]
    vertices = np.column_stack(axes) * directory["step"] + np.array(directory["origin"])
    thickness = running() * directory["thicknessStep"] if entry["thickness"] else np.zeros(0)
    values, value, shift = [], 0, 0
    for byte in part[at:]:
        value |= (byte & 127) << shift
        shift += 7
        if not byte & 128:
            values.append(value)
            value = shift = 0
    steps = _unzigzag(np.array(values)).reshape(-1, 3)
    first = np.cumsum(steps[:, 0])
    faces = np.column_stack([first, first + steps[:, 1], first + steps[:, 2]])
    assert len(faces) == entry["triangles"] == sum(i["triangles"] for i in entry["layers"])
    return vertices, faces, thickness


def _unzigzag(values: np.ndarray) -> np.ndarray:
    return np.where(values & 1, -((values + 1) >> 1), values >> 1)
