"""Unpacks MeatPack, which stores the commonest characters of G-code in four bits each.

After Scott Mudge's algorithm (github.com/scottmudge/OctoPrint-MeatPack) as libbgcode uses it.  In a
packed byte the low half is the first character and the high half the second; 15 says that the
character follows as a whole byte.  After a packed end of line as first character, the second does
not count.  Two bytes 255 and a number switch packing, and spaces, on and off.
"""

from __future__ import annotations

_SIGNAL = 0xFF
_PACK, _PLAIN, _RESET, _NO_SPACES, _SPACES = 251, 250, 249, 247, 246
_WHOLE = 15


def _tables(space: str) -> tuple[tuple[bytes | None, ...], tuple[tuple[bytes, bytes], ...]]:
    """For each byte: its text, None where whole characters follow; and its two characters.

    A character that follows as a whole byte is empty here.
    """
    letters = [*(letter.encode() for letter in f"0123456789.{space}\nGX"), b""]
    pairs = tuple((letters[byte & 15], letters[byte >> 4]) for byte in range(256))
    texts = tuple(
        first if first == b"\n" else first + second if first and second else None
        for first, second in pairs
    )
    return texts, pairs


_WITH_SPACES, _WITHOUT_SPACES = _tables(" "), _tables("E")


def unpacked(data: bytes) -> bytes:
    """The text of packed data; at most twice as long.  Whole bytes missing at the end are left out.

    The packing ends with the data: each block of a file is packed by itself.
    """
    out: list[bytes] = []
    packing = False
    texts, pairs = _WITH_SPACES
    at, end = 0, len(data)
    while at < end:
        byte = data[at]
        if byte == _SIGNAL and data[at + 1 : at + 2] == b"\xff":
            command = data[at + 2] if at + 2 < end else 0
            at += 3
            if command in (_PACK, _PLAIN, _RESET):
                packing = command == _PACK
            elif command in (_NO_SPACES, _SPACES):
                texts, pairs = _WITHOUT_SPACES if command == _NO_SPACES else _WITH_SPACES
            continue
        if not packing:
            following = data.find(b"\xff\xff", at)
            stop = end if following < 0 else following
            out.append(data[at:stop])
            at = stop
            continue
        at += 1
        text = texts[byte]
        if text is not None:
            out.append(text)
            continue
        first, second = pairs[byte]
        if not first:
            first = data[at : at + 1]
            at += 1
        if not second:
            second = data[at : at + 1]
            at += 1
        out.append(first)
        out.append(second)
    return b"".join(out)
