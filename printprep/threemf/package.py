"""Packs the zip container of a 3MF: the same parts give the same bytes, on every system.

Source: ECMA-376 part 2 (Open Packaging Conventions); 3MF core specification 1.3, section 2.
The bytes are the same wherever zlib is the same; zlib-ng packs differently.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Mapping

from printprep.threemf.xml_text import escape

MODEL_PART = "3D/3dmodel.model"
THUMBNAIL_PART = "Metadata/thumbnail.png"
CONFIG_PART = "Metadata/Slic3r_PE_model.config"
ORCA_CONFIG_PART = "Metadata/model_settings.config"

_HEAD = '<?xml version="1.0" encoding="UTF-8"?>\n'
_TYPES = "http://schemas.openxmlformats.org/package/2006/content-types"
_RELATIONS = "http://schemas.openxmlformats.org/package/2006/relationships"
_MODEL_RELATION = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
_THUMBNAIL_RELATION = f"{_RELATIONS}/metadata/thumbnail"
_KNOWN_TYPES = {
    "rels": "application/vnd.openxmlformats-package.relationships+xml",
    "model": "application/vnd.ms-package.3dmanufacturing-3dmodel+xml",
    "png": "image/png",
    "json": "application/json",
    "config": "application/xml",
    "txt": "text/plain",
}
_EPOCH = (1980, 1, 1, 0, 0, 0)  # the earliest time a zip can hold
_UNIX = 3
_READABLE = 0o100644 << 16


def pack(parts: Mapping[str, bytes]) -> bytes:
    """Zip `parts` (part name without leading slash → content), with types and relationships.

    Raises ValueError for a part whose suffix has no content type, or whose name is not a plain
    relative path.
    """
    suffixes = {"rels"}
    for name in parts:
        suffix = name.rpartition(".")[2]
        pieces = name.split("/")
        if suffix not in _KNOWN_TYPES or "\\" in name or not name.isascii():
            raise ValueError(f"{name!r} has a suffix or characters that no part of a 3MF has")
        if any(piece.strip(". ") != piece or not piece for piece in pieces[:-1]):
            raise ValueError(f"{name!r} is not a plain relative path, as a part of a 3MF needs")
        suffixes.add(suffix)
    whole = {"[Content_Types].xml": _types(sorted(suffixes)), "_rels/.rels": _rels(parts), **parts}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, content in whole.items():
            entry = zipfile.ZipInfo(name, date_time=_EPOCH)
            entry.create_system = _UNIX
            entry.external_attr = _READABLE
            entry.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(entry, content, compresslevel=6)
    return buffer.getvalue()


def _types(suffixes: list[str]) -> bytes:
    lines = [
        f' <Default Extension="{suffix}" ContentType="{_KNOWN_TYPES[suffix]}"/>\n'
        for suffix in suffixes
    ]
    return f'{_HEAD}<Types xmlns="{_TYPES}">\n{"".join(lines)}</Types>\n'.encode()


def _rels(parts: Mapping[str, bytes]) -> bytes:
    relations = [(MODEL_PART, _MODEL_RELATION), (THUMBNAIL_PART, _THUMBNAIL_RELATION)]
    lines = [
        f' <Relationship Target="/{escape(part)}" Id="rel-{number}" Type="{kind}"/>\n'
        for number, (part, kind) in enumerate(relations, 1)
        if part in parts
    ]
    return (
        f'{_HEAD}<Relationships xmlns="{_RELATIONS}">\n{"".join(lines)}</Relationships>\n'.encode()
    )
