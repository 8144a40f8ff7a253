"""The blocks of a binary G-code file, read one by one.

The layout is that of Prusa's specification (github.com/prusa3d/libbgcode, doc/specifications.md),
version 1: a header of 10 bytes, then blocks.  A block is a header (type, compression, size, and
where it is compressed its stored size), parameters (2 bytes; 6 for a thumbnail), the data, and
where the file header says so a CRC32 of all of it.  Integers are little-endian.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO

from printprep.errors import InputError

MAGIC = b"GCDE"
FILE_METADATA, GCODE, SLICER_METADATA, PRINTER_METADATA, PRINT_METADATA, THUMBNAIL = range(6)
STORED, DEFLATE, HEATSHRINK_11, HEATSHRINK_12 = range(4)

_VERSION = 1
_FILE_HEADER = struct.Struct("<4sIH")
_NO_CHECKSUM, _CRC32 = 0, 1
_HEADER = struct.Struct("<HHI")
_SIZE = struct.Struct("<I")
_KINDS = {
    FILE_METADATA: "file metadata",
    GCODE: "G-code",
    SLICER_METADATA: "slicer metadata",
    PRINTER_METADATA: "printer metadata",
    PRINT_METADATA: "print metadata",
    THUMBNAIL: "thumbnail",
}
_EXPORT_AGAIN = "Export it again from the slicer."
BLOCK_BYTES_MAX = 64 << 20  # slicers write blocks of 64 KiB; a thumbnail can be larger


@dataclass(frozen=True)
class Block:
    """One block.

    start, end : its place in the file, bytes;  kind : one of the types above;  compression : one of
    those above;  size : of the data when uncompressed;  parameters, data : as stored.
    """

    start: int
    end: int
    kind: int
    compression: int
    size: int
    parameters: bytes
    data: bytes

    @property
    def encoding(self) -> int:
        """The encoding of the data, for every type but a thumbnail."""
        return int.from_bytes(self.parameters[:2], "little")


def is_binary(head: bytes) -> bool:
    """Whether a file that begins with these bytes is binary G-code."""
    return head.startswith(MAGIC)


def read_blocks(file: BinaryIO, name: str) -> Iterator[Block]:
    """The blocks of a file, one in memory at a time; their checksums are compared.

    name : of the file, for errors.

    Raises InputError for another version, a block that the file does not hold whole, an unknown
    type, or a wrong checksum.
    """
    file_bytes = os.fstat(file.fileno()).st_size
    checksummed = read_header(file, name)
    while (start := file.tell()) < file_bytes:
        header = _exactly(file, _HEADER.size, name, start)
        kind, compression, size = _HEADER.unpack(header)
        if kind not in _KINDS or compression > HEATSHRINK_12:
            raise InputError(
                f"{name}: at byte {start} stands no block of binary G-code (type {kind}, "
                f"compression {compression}).",
                _EXPORT_AGAIN,
            )
        stored = size
        if compression != STORED:
            length = _exactly(file, _SIZE.size, name, start)
            (stored,) = _SIZE.unpack(length)
            header += length
        if max(size, stored) > BLOCK_BYTES_MAX:
            raise InputError(
                f"{name}: the {_KINDS[kind]} block at byte {start} is said to hold "
                f"{max(size, stored)} bytes; at most {BLOCK_BYTES_MAX >> 20} MiB are read.",
                _EXPORT_AGAIN,
            )
        parameters = _exactly(file, 6 if kind == THUMBNAIL else 2, name, start)
        data = _exactly(file, stored, name, start)
        if checksummed:
            (checksum,) = _SIZE.unpack(_exactly(file, _SIZE.size, name, start))
            if zlib.crc32(data, zlib.crc32(header + parameters)) != checksum:
                raise InputError(
                    f"{name}: the {_KINDS[kind]} block at byte {start} is damaged: its checksum "
                    "is wrong.",
                    _EXPORT_AGAIN,
                )
        yield Block(start, file.tell(), kind, compression, size, parameters, data)


def read_header(file: BinaryIO, name: str) -> bool:
    """Read the head of a file; whether its blocks have a checksum.

    Raises InputError for another format, version or kind of checksum.
    """
    head = file.read(_FILE_HEADER.size)
    if len(head) < _FILE_HEADER.size or not is_binary(head):
        raise InputError(f"{name} is cut off: its header is not whole.", _EXPORT_AGAIN)
    _, version, checksum = _FILE_HEADER.unpack(head)
    if version != _VERSION or checksum > _CRC32:
        raise InputError(
            f"{name} is binary G-code of version {version} with checksums of type {checksum}; "
            f"version {_VERSION} with types 0 and 1 is read.",
            "Export it as text (binary_gcode = 0), or with another version of the slicer.",
        )
    return bool(checksum == _CRC32)


def gcode_block(text: bytes, *, checksummed: bool) -> bytes:
    """A block of G-code as it stands in a file: neither compressed nor encoded."""
    block = _HEADER.pack(GCODE, STORED, len(text)) + b"\0\0" + text
    return block + _SIZE.pack(zlib.crc32(block)) if checksummed else block


def _exactly(file: BinaryIO, count: int, name: str, start: int) -> bytes:
    found = file.read(count)
    if len(found) < count:
        raise InputError(
            f"{name} is cut off: it ends within the block at byte {start}.", _EXPORT_AGAIN
        )
    return found
