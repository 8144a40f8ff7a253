"""Writes a 3MF that its slicer prints as intended and lib3mf reads strictly without a warning.

For PrusaSlicer one item is one object: one mesh, made of volumes one after another, each with its
own range of vertices and triangles.  Metadata/Slic3r_PE_model.config says what each volume is for.
OrcaSlicer and BambuStudio read another layout (:mod:`printprep.threemf.orca`).
Cavities belong to the mesh of a ModelPart, as inverted shells.

The file never holds a print config or a post_process key: both can carry commands that a slicer
runs when it opens the file.

Source: 3MF core specification 1.3; PrusaSlicer's src/libslic3r/Format/3mf.cpp for the config.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal, get_args

import numpy as np

from printprep.errors import UsageError
from printprep.threemf import orca
from printprep.threemf.item import Item, Volume, VolumeKind
from printprep.threemf.mesh_xml import mesh_lines
from printprep.threemf.package import (
    CONFIG_PART,
    MODEL_PART,
    ORCA_CONFIG_PART,
    THUMBNAIL_PART,
    pack,
)
from printprep.threemf.painting import (
    PRUSA_STROKES,
    Painter,
    material_lines,
    materials_of,
    painting_versions,
)
from printprep.threemf.xml_text import clean, escape

__all__ = ["Dialect", "Item", "Volume", "VolumeKind", "write_3mf"]

Dialect = Literal["prusa", "orca", "plain"]
"""Whose config a file holds, and in whose layout its volumes are."""

_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
_SLIC3R = "http://schemas.slic3r.org/3mf/2017/06"
# Names from the core specification, without its two dates: the same part gives the same file.
_METADATA = (
    "Title",
    "Designer",
    "Description",
    "Copyright",
    "LicenseTerms",
    "Rating",
    "Application",
)

_ATTACHMENT = re.compile(r"Metadata/[A-Za-z0-9_-]+\.(json|txt)")


def write_3mf(
    items: Sequence[Item],
    *,
    thumbnail_png: bytes | None = None,
    attachments: Mapping[str, bytes] | None = None,
    metadata: Mapping[str, str] | None = None,
    dialect: Dialect = "prusa",
    strokes: Mapping[str, str] = PRUSA_STROKES,
) -> bytes:
    """The 3MF file as bytes; the same arguments give the same bytes.

    attachments : part name ("Metadata/printprep.json") → content, JSON or text;
    metadata : name from the core specification ("Title", "Application", …) → text;
    dialect : the slicer's config that the settings are written in, in that slicer's own keys;
    "plain" leaves them out;
    strokes : the attribute of a triangle for each kind of paint, none for a kind that is left out.

    Raises UsageError for a setting that no file for a slicer may carry, ValueError for geometry or
    a part that would make the file invalid.
    """
    if not items:
        raise ValueError("a 3MF needs at least one item")
    for item in items:
        _check(item)
    parts = {MODEL_PART: _model(items, metadata or {}, strokes, dialect)}
    if dialect == "prusa":
        parts[CONFIG_PART] = _config(items)
    elif dialect == "orca":
        parts[ORCA_CONFIG_PART] = orca.config(items)
    if thumbnail_png is not None:
        parts[THUMBNAIL_PART] = thumbnail_png
    for name, content in sorted((attachments or {}).items()):
        if not _ATTACHMENT.fullmatch(name):
            raise ValueError(f"{name!r} cannot be attached: use Metadata/NAME.json or NAME.txt")
        parts[name] = content
    return pack(parts)


def _check(item: Item) -> None:
    if not any(volume.kind == "ModelPart" for volume in item.volumes):
        raise ValueError(f"item {item.name!r} has no ModelPart: slicers refuse such an object")
    if not np.isfinite(item.translation_mm).all():
        raise ValueError(f"item {item.name!r} has a translation that is not finite")
    _check_settings(item.name, item.settings)
    for volume in item.volumes:
        vertices, faces = volume.vertices, volume.faces
        if volume.kind not in get_args(VolumeKind):
            raise ValueError(f"volume {volume.name!r} is of an unknown kind {volume.kind!r}")
        if vertices.ndim != 2 or vertices.shape[1] != 3 or faces.ndim != 2 or faces.shape[1] != 3:
            raise ValueError(f"volume {volume.name!r} is not (n, 3) vertices and (m, 3) faces")
        if not len(faces):
            raise ValueError(f"volume {volume.name!r} has no triangles")
        with np.errstate(over="ignore"):
            finite = np.isfinite(vertices.astype(np.float32)).all()
        if not finite:
            raise ValueError(f"volume {volume.name!r} has coordinates that are not finite float32")
        if faces.min() < 0 or faces.max() >= len(vertices):
            raise ValueError(f"volume {volume.name!r} has an index beyond its vertices")
        if (faces == np.roll(faces, 1, axis=1)).any():
            raise ValueError(f"volume {volume.name!r} has a triangle that names a vertex twice")
        if volume.paint is not None and volume.paint.labels.shape != (len(faces),):
            raise ValueError(f"volume {volume.name!r} has paint for another number of triangles")
        _check_settings(volume.name, volume.settings)


def _check_settings(owner: str, settings: Mapping[str, str]) -> None:
    for key, value in settings.items():
        if key == "post_process":
            raise UsageError(
                f"{owner!r} must not carry post_process: a slicer runs it as a command.",
                "Put post-processing into the slicer's print settings.",
            )
        # name and the volume's placement are keys of the same list, and this module writes them.
        if not re.fullmatch(r"[a-z][a-z0-9_]*", key) or key in ("name", "volume_type", "matrix"):
            raise UsageError(f"{owner!r}: {key!r} is not a setting of an object in a slicer.")
        if clean(value) != value:
            raise UsageError(f"{owner!r}: {key} has characters that a 3MF cannot hold.")


def _model(
    items: Sequence[Item],
    metadata: Mapping[str, str],
    strokes: Mapping[str, str],
    dialect: Dialect,
) -> bytes:
    unknown = sorted(set(metadata) - set(_METADATA))
    if unknown:
        raise ValueError(f"no such 3MF metadata: {', '.join(unknown)}")
    prusa = dialect != "orca"  # a plain file is PrusaSlicer's without its config
    namespace = f' xmlns:slic3rpe="{_SLIC3R}"' if prusa else ""
    chunks = [
        '<?xml version="1.0" encoding="UTF-8"?>\n'
        f'<model unit="millimeter" xml:lang="en-US" xmlns="{_CORE}"{namespace}>\n'.encode()
    ]
    if prusa:
        chunks.append(b' <metadata name="slic3rpe:Version3mf">1</metadata>\n')
    chunks += [
        f' <metadata name="{name}">{escape(metadata[name])}</metadata>\n'.encode()
        for name in sorted(metadata)
    ]
    chunks += painting_versions(items, strokes)
    chunks.append(b" <resources>\n")
    materials = materials_of(items)
    group = (len(items) if prusa else orca.object_count(items)) + 1
    chunks += material_lines(materials, group)
    painter = Painter(materials, group, strokes)
    chunks += _objects(items, painter) if prusa else orca.object_lines(items, painter)
    chunks.append(b" </resources>\n <build>\n")
    chunks += _build(items) if prusa else orca.build_lines(items)
    chunks.append(b" </build>\n</model>\n")
    return b"".join(chunks)


def _objects(items: Sequence[Item], painter: Painter) -> Iterator[bytes]:
    for number, item in enumerate(items, 1):
        default, name = painter.default(item), escape(item.name)
        yield f'  <object id="{number}" type="model" name="{name}"{default}>\n'.encode()
        yield from mesh_lines(item.volumes, painter)
        yield b"  </object>\n"


def _build(items: Sequence[Item]) -> Iterator[bytes]:
    for number, item in enumerate(items, 1):
        x, y, z = (f"{float(value):.9g}" for value in item.translation_mm)
        move = f"1 0 0 0 1 0 0 0 1 {x} {y} {z}"
        yield f'  <item objectid="{number}" transform="{move}"/>\n'.encode()


def _config(items: Sequence[Item]) -> bytes:
    lines = ['<?xml version="1.0" encoding="UTF-8"?>', "<config>"]
    for number, item in enumerate(items, 1):
        lines.append(f' <object id="{number}" instances_count="1">')
        lines += _keys("  ", "object", {"name": item.name, **_sorted(item.settings)})
        first = 0
        for volume in item.volumes:
            last = first + len(volume.faces) - 1  # inclusive
            lines.append(f'  <volume firstid="{first}" lastid="{last}">')
            own = {"name": volume.name, "volume_type": volume.kind}
            lines += _keys("   ", "volume", {**own, **_sorted(volume.settings)})
            lines.append("  </volume>")
            first = last + 1
        lines.append(" </object>")
    lines.append("</config>\n")
    return "\n".join(lines).encode()


def _sorted(settings: Mapping[str, str]) -> dict[str, str]:
    return {key: settings[key] for key in sorted(settings)}


def _keys(indent: str, owner: str, values: Mapping[str, str]) -> list[str]:
    return [
        f'{indent}<metadata type="{owner}" key="{key}" value="{escape(value)}"/>'
        for key, value in values.items()
    ]
