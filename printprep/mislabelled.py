"""Tells a file whose content is of another format than its suffix says.

Downloads are often archives, pages or other models under the name of the model.  A reader would
take their bytes for a damaged file of its own format, and say what does not help.
"""

from __future__ import annotations

import struct
from dataclasses import dataclass

from printprep.errors import InputError


@dataclass(frozen=True)
class _Format:
    """begins : its first bytes;  name : with its article;  suffix : its own, where it is read."""

    begins: bytes
    name: str
    suffix: str | None = None
    way_out: str = "Unpack it, and name the model that is in it."


_EXPORT = "Open it in a modelling program, and export it as STL or 3MF."
_FORMATS = (
    _Format(b"PK\x03\x04", "a ZIP archive"),
    _Format(b"\x1f\x8b", "a gzip archive"),
    _Format(b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
    _Format(b"Rar!", "a RAR archive"),
    _Format(b"glTF", "a GLB file", ".glb"),
    _Format(b"ply\n", "a PLY file", ".ply"),
    _Format(b"ply\r", "a PLY file", ".ply"),
    _Format(b"ISO-10303-21", "a STEP file", None, _EXPORT),
    _Format(b"BLENDER", "a Blender file", None, _EXPORT),
    _Format(b"Kaydara FBX", "an FBX file", None, _EXPORT),
    _Format(b"%PDF", "a PDF", None, "Name the file of the model."),
    _Format(b"\x89PNG", "a picture", None, "Name the file of the model."),
    _Format(b"\xff\xd8\xff", "a picture", None, "Name the file of the model."),
)
_PAGE = _Format(
    b"", "a web page", None, "Download the model itself: this is a page about it, or an error."
)
_PAGE_BEGINS = (b"<!doctype html", b"<html")
_3MF = _Format(b"PK\x03\x04", "a 3MF file", ".3mf")
_STL = _Format(b"", "an STL file", ".stl")
# The first entries of a 3MF; each entry's name stands in the first kilobytes of the archive.
_3MF_PARTS = (b"[Content_Types].xml", b"_rels/.rels", b"3D/3dmodel.model")
_HEAD_BYTES = 4096


def refuse_mislabelled(data: bytes, suffix: str, what: str) -> None:
    """Raise InputError where a file is surely of another format; ``what`` names it.

    suffix : that of its name, with its dot, in lower case.
    """
    if suffix == ".stl" and _is_binary_stl(data):
        return  # its header may begin with anything
    found = _format_of(data)
    if found is None or found.suffix == suffix:
        return
    way_out = f"Give it the suffix {found.suffix}." if found.suffix else found.way_out
    raise InputError(f"{what} is {found.name}, not what its suffix {suffix} says.", way_out)


def _format_of(data: bytes) -> _Format | None:
    head = data[:_HEAD_BYTES]
    if head.startswith(_3MF.begins) and any(part in head for part in _3MF_PARTS):
        return _3MF
    for known in _FORMATS:
        if head.startswith(known.begins):
            return known
    text = head.lstrip()
    if text.lower().startswith(_PAGE_BEGINS):
        return _PAGE
    if _is_binary_stl(data) or (text[:5].lower() == b"solid" and b"facet" in text.lower()):
        return _STL
    return None


def _is_binary_stl(data: bytes) -> bool:
    """Whether the size is what the number of facets in the header asks for (50 bytes each)."""
    return len(data) > 84 and len(data) == 84 + 50 * int(struct.unpack_from("<I", data, 80)[0])
