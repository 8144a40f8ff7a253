"""Splits G-code text into arrays: all lines with moves at once, without a loop over lines.

Notation of the arrays: n rows (lines with G0–G3, G28 or G92), in the order of the file; a row has
its words in the columns of ``WORDS``, NaN where it lacks one.  A line that begins with one of these
words is a move like the one before it.  Line numbers (N) are skipped.  All other lines that are not
empty go to :mod:`printprep.gcode.modal_state`, one by one: there are few.  In helpers ``data`` is
the text as bytes (b,), and ``starts``, ``ends`` are places in it, one for each line.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError
from printprep.wording import shortened

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from printprep.arrays import Bool, Float, Int

    Bytes = NDArray[np.uint8]

WORDS = "XYZEIJR"
X, Y, Z, E, I, J, R = range(len(WORDS))  # noqa: E741  the letters G-code has
HOME, SET = 28, 92

_BEYOND = 8  # zero bytes after the text, so that looking ahead needs no bounds check
_DIGITS_MAX = 18  # what int64 holds
_STEPS = 8  # blanks and digits in a row that are walked over one by one
_BLANK = np.zeros(256, dtype=bool)
_BLANK[list(b" \t")] = True
_DIGIT = np.zeros(256, dtype=bool)
_DIGIT[list(b"0123456789")] = True
_NUMBER = np.zeros(256, dtype=bool)
_NUMBER[list(b"0123456789.+-")] = True
_COLUMN = np.full(256, -1, dtype=np.int8)
for _column, _letter in enumerate(WORDS):
    _COLUMN[[ord(_letter), ord(_letter.lower())]] = _column
_NAME = np.zeros(256, dtype=bool)  # characters that make another word of a G1 that they follow
_NAME[list(b"0123456789._")] = True


@dataclass(frozen=True, eq=False)
class Rows:
    """One piece of a file.

    line : (n,) int64, which line of the piece;  kind : (n,) int64: 0–3, 28 or 92;
    words : (n, 7) float64 in the units of the file, columns as ``WORDS``;
    others : (line of the piece, text) of all other lines, in order;
    lines : number of lines in the piece;  motion : the last of G0–G3 so far, −1 before any.
    """

    line: Int
    kind: Int
    words: Float
    others: tuple[tuple[int, bytes], ...]
    lines: int
    motion: int


def read_rows(text: bytes, where: str, first_line: int, motion: int = -1) -> Rows:
    """Split a piece of G-code, which ends with the end of a line.

    where : name of the file, and first_line : number of the piece's first line, for errors;
    motion : the last of G0–G3 before the piece.

    Raises InputError for a malformed number.
    """
    data = np.frombuffer(text + bytes(_BEYOND), dtype=np.uint8)
    ends = np.flatnonzero(data[: len(text)] == ord("\n"))
    starts = np.concatenate([[0], ends[:-1] + 1]) if len(ends) else ends
    starts = _after_number(data, _after_blanks(data, starts))
    kind, bare, motion = _as_before(data, starts, _kinds(data, starts), motion)
    moving = np.flatnonzero(kind >= 0)
    code_ends = ends.copy()
    for mark in b";(*":  # comments, and checksums as hosts append them
        _cut(data, mark, starts, code_ends)
    span = starts[moving], code_ends[moving]
    begin = span[0] + ~bare[moving]  # after the G, if there is one
    words = _words(data, *span, begin, kind[moving], where, first_line + moving)
    words[kind[moving] == HOME] = np.nan  # words of G28 only name axes
    rest = np.flatnonzero((kind < 0) & (starts < ends))
    others = tuple(
        (line, text[start:end])
        for line, start, end in zip(
            rest.tolist(), starts[rest].tolist(), ends[rest].tolist(), strict=True
        )
    )
    return Rows(moving, kind[moving], words, others, len(ends), motion)


def _after_blanks(data: Bytes, at: Int) -> Int:
    """(k,) the first places from ``at`` (k,) on that hold no blank."""
    return _beyond(data, at, _BLANK)


def _beyond(data: Bytes, at: Int, among: Bool) -> Int:
    """(k,) the first places from ``at`` (k,) on whose character is not ``among`` (256,)."""
    running = among[data[at]]
    for _ in range(_STEPS):
        if not running.any():
            return at
        at = at + running
        running = among[data[at]]
    if running.any():  # long runs: look the ends up instead of walking to them
        others = np.flatnonzero(~among[data])
        at = at.copy()
        at[running] = others[np.searchsorted(others, at[running])]
    return at


def _after_number(data: Bytes, at: Int) -> Int:
    """(k,) places ``at`` (k,), moved behind the line number (N and digits) where there is one."""
    numbered = ((data[at] == ord("N")) | (data[at] == ord("n"))) & _digit(data[at + 1])
    if not numbered.any():
        return at
    behind = _beyond(data, at + numbered, _DIGIT)
    return np.where(numbered, _after_blanks(data, behind), at)


def _as_before(data: Bytes, starts: Int, kind: Int, motion: int) -> tuple[Int, Bool, int]:
    """(k,) kinds with bare words as moves, (k,) which lines those are, and the last move's kind.

    starts, kind : (k,), of each line;  motion : kind of the last move before them.
    """
    moves = (kind >= 0) & (kind <= 3)
    word = (_COLUMN[data[starts]] >= 0) & _NUMBER[data[_after_blanks(data, starts + 1)]]
    at = np.where(moves, np.arange(len(kind)), -1)
    last = np.maximum.accumulate(at) if len(at) else at
    current = np.where(last >= 0, kind[last], motion)
    bare = (kind < 0) & word & (current >= 0)
    return np.where(bare, current, kind), bare, int(current[-1]) if len(current) else motion


def _kinds(data: Bytes, starts: Int) -> Int:
    """(k,) the G number of each line that is a row, −1 elsewhere; starts : (k,)."""
    number = starts + 1
    # G01 is G1
    number = number + ((data[number] == ord("0")) & _digit(data[number + 1]))
    first, second, third = data[number], data[number + 1], data[number + 2]
    kind = np.full(len(starts), -1, dtype=np.int64)
    single = (first >= ord("0")) & (first <= ord("3")) & ~_NAME[second]
    kind[single] = first[single] - ord("0")
    for code in (HOME, SET):
        tens, ones = f"{code}".encode()
        kind[(first == tens) & (second == ones) & ~_NAME[third]] = code
    letter = data[starts]
    kind[(letter != ord("G")) & (letter != ord("g"))] = -1
    return kind


def _digit(data: Bytes) -> Bool:
    digits: Bool = (data >= ord("0")) & (data <= ord("9"))
    return digits


def _cut(data: Bytes, mark: int, starts: Int, code_ends: Int) -> None:
    """Move the ends of code (k,) to the first ``mark`` of each line, in place; starts : (k,)."""
    at = np.flatnonzero(data == mark)
    if len(at):
        line = np.searchsorted(starts, at, side="right") - 1
        at, line = at[line >= 0], line[line >= 0]
        np.minimum.at(code_ends, line, at)


def _words(
    data: Bytes, starts: Int, ends: Int, begin: Int, kind: Int, where: str, numbers: Int
) -> Float:
    """(n, 7) float64, the words of the rows.

    starts, ends, begin : (n,) places of each row and of its first word;  kind : (n,);
    where, numbers : name of the file and (n,) line numbers, for errors.
    """
    words = np.full((len(starts), len(WORDS)), np.nan)
    if not len(starts):
        return words
    edge = np.zeros(len(data) + 1, dtype=np.int8)
    edge[begin] += 1
    edge[np.maximum(ends, begin)] -= 1
    active = np.cumsum(edge[:-1], dtype=np.int8).astype(bool)
    at = np.flatnonzero(active & (_COLUMN[data] >= 0))
    row = np.searchsorted(starts, at, side="right") - 1
    values, sound = _numbers(data, _after_blanks(data, at + 1))
    sound |= kind[row] == HOME
    if not sound.all():
        wrong = int(np.argmin(sound))
        line = numbers[row[wrong]]
        begin_of, end_of = starts[row[wrong]], ends[row[wrong]]
        text = shortened(bytes(data[begin_of:end_of]).decode("ascii", "replace"))
        raise InputError(
            f"{where}, line {line}: '{text}' has a word without a valid number.",
            "Slice the model again.",
        )
    words[row, _COLUMN[data[at]]] = values
    return words


def _numbers(data: Bytes, at: Int) -> tuple[Float, Bool]:
    """(k,) the decimal numbers that begin at ``at`` (k,), and (k,) which of them are well formed.

    The digits become one integer, which is divided once by a power of ten; both are exact in double
    precision up to 2⁵³ and 10²², so the result is the nearest double.
    """
    n = len(at)
    total = np.zeros(n, dtype=np.int64)
    digits = np.zeros(n, dtype=np.int64)
    decimals = np.zeros(n, dtype=np.int64)
    dots = np.zeros(n, dtype=np.int64)
    here = data[at]
    negative = here == ord("-")
    at = at + (negative | (here == ord("+")))
    sound = np.ones(n, dtype=bool)
    running = np.ones(n, dtype=bool)
    for _ in range(_DIGITS_MAX + 1):
        here = data[at]
        running &= _NUMBER[here]
        if not running.any():
            break
        digit = running & _digit(here)
        total = np.where(digit, total * 10 + (here.astype(np.int64) - ord("0")), total)
        digits += digit
        decimals += digit & (dots > 0)
        dots += running & (here == ord("."))
        sound &= ~running | digit | (here == ord("."))
        at = at + running
    sound &= (digits > 0) & (digits <= _DIGITS_MAX) & (dots <= 1) & ~_NUMBER[data[at]]
    value = total / 10.0**decimals
    return np.where(negative, -value, value), sound
