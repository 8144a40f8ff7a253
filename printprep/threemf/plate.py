"""The G-code inside a sliced project, a 3MF as BambuStudio and OrcaSlicer export it (.gcode.3mf).

It is a zip file with the G-code of each sliced plate, ``Metadata/plate_1.gcode`` and so on, and its
MD5 beside it.
"""

from __future__ import annotations

import re
import zipfile
import zlib
from collections.abc import Iterator
from typing import BinaryIO

from printprep.errors import InputError

ZIP_MAGIC = b"PK\x03\x04"
_PLATE = re.compile(r"/?Metadata/plate_(\d+)\.gcode", re.IGNORECASE)
_COPY_BYTES = 1 << 20
# Deflated G-code is about a fourth of its text; more than this is a zip bomb.
_RATIO_MAX = 100
_SMALL_BYTES = 1 << 20

ZIP_ERRORS = (zipfile.BadZipFile, zlib.error, RuntimeError, NotImplementedError, EOFError, OSError)
"""What reading a damaged, encrypted or unusual zip file raises."""


def plate_in(archive: zipfile.ZipFile, name: str) -> zipfile.ZipInfo:
    """The entry that holds the G-code.  name : of the file, for errors.

    Raises InputError where there is none, or more than one plate is sliced.
    """
    plates = [entry for entry in archive.infolist() if _PLATE.fullmatch(entry.filename)]
    if not plates:
        raise InputError(
            f"{name} is an archive without G-code: it has no Metadata/plate_1.gcode.",
            "Export the sliced plate (.gcode or .gcode.3mf) from the slicer.",
        )
    if len(plates) > 1:
        raise InputError(
            f"{name} holds the G-code of {len(plates)} plates.",
            "Export one sliced plate only.",
        )
    return plates[0]


def plate_text(file: BinaryIO, name: str) -> Iterator[bytes]:
    """The G-code in a sliced project, in pieces.

    Raises InputError where it holds none, or is damaged, or is a zip bomb.
    """
    try:
        with zipfile.ZipFile(file) as archive:
            entry = plate_in(archive, name)
            limit = max(_SMALL_BYTES, _RATIO_MAX * entry.compress_size)
            read = 0
            with archive.open(entry) as plate:
                while piece := plate.read(_COPY_BYTES):
                    read += len(piece)
                    if read > limit:
                        raise InputError(
                            f"{name} is refused: {entry.filename} unpacks to more than "
                            f"{_RATIO_MAX} times its size.",
                        )
                    yield piece
    except ZIP_ERRORS as error:
        raise InputError(f"{name} is not a sound archive: {error}.") from error
