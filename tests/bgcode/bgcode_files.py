"""Binary G-code made for tests: any text, in every compression and encoding."""

from __future__ import annotations

import struct
import zlib
from collections.abc import Sequence

import heatshrink2

CODES = {letter: code for code, letter in enumerate(b"0123456789. \nGX")}
DATA_BYTES = 4096  # of a block, as small as to make several


def packed(text: bytes, *, spaces: bool = True) -> bytes:
    """Text in MeatPack: pairs of characters from the start of each line; comments stay as they are.

    spaces : whether a blank is packed, or the letter E in its place.
    """
    codes = CODES if spaces else {**CODES, ord("E"): 11, ord(" "): None}
    out, packing = bytearray(), False
    for line in text.splitlines(keepends=True):
        if line.startswith(b";"):
            if packing:
                out += b"\xff\xff\xfa"
            packing = False
            out += line
            continue
        if not packing:
            out += b"\xff\xff\xfb" + (b"\xff\xff\xf6" if spaces else b"\xff\xff\xf7")
        packing = True
        if len(line) % 2:
            line += b"\n"  # its second half is not read after the end of a line
        for first, second in zip(line[::2], line[1::2], strict=True):
            low, high = codes.get(first), codes.get(second)
            out.append((15 if low is None else low) | (15 if high is None else high) << 4)
            out += bytes([first]) if low is None else b""
            out += bytes([second]) if high is None else b""
    return bytes(out)


def compressed(data: bytes, how: int) -> bytes:
    if how == 1:
        return zlib.compress(data)
    if how in (2, 3):
        return bytes(heatshrink2.compress(data, window_sz2=9 + how, lookahead_sz2=4))
    return data


def block(
    kind: int, data: bytes, how: int = 0, encoding: int = 0, *, checksum: bool = True
) -> bytes:
    stored = compressed(data, how)
    head = struct.pack("<HHI", kind, how, len(data))
    head += struct.pack("<I", len(stored)) if how else b""
    head += struct.pack("<HHH", 0, 1, 1) if kind == 5 else struct.pack("<H", encoding)
    whole = head + stored
    return whole + struct.pack("<I", zlib.crc32(whole)) if checksum else whole


def binary(
    text: bytes,
    metadata: bytes = b"filament_diameter=1.75\nfilament_density=1.25\n",
    *,
    how: int = 0,
    encoding: int = 0,
    checksum: bool = True,
    extra: Sequence[bytes] = (),
) -> bytes:
    """A file of this G-code, in blocks that may end within a line where nothing is packed."""
    blocks = [block(0, b"Producer=PrusaSlicer 2.9.2\n", checksum=checksum), *extra]
    blocks.append(block(2, metadata, how, checksum=checksum))
    lines, piece = text.splitlines(keepends=True), b""
    pieces = []
    for line in lines:
        piece += line
        if len(piece) >= DATA_BYTES:
            pieces.append(piece)
            piece = b""
    for each in [*pieces, piece]:
        data = packed(each, spaces=encoding == 2) if encoding else each
        blocks.append(block(1, data, how, encoding, checksum=checksum))
    return struct.pack("<4sIH", b"GCDE", 1, checksum) + b"".join(blocks)
