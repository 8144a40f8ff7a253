"""Small pieces of sentences that several messages need."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

_PIECE_MIN = 3


def counted(number: int, noun: str) -> str:
    """A number with its noun ("1 shell", "2 shells"), for nouns whose plural ends in s."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def printable(text: str) -> str:
    """A text from a file with its control characters written out ("\\x1b"), so that none acts.

    Line ends and tabs become one space each; letters of every script stay as they are.
    """
    return "".join(
        char if char.isprintable() else " " if char in "\t\n\r" else _written_out(char)
        for char in text
    )


def shortened(text: str, most: int = 60) -> str:
    """A text from a file, printable, cut to ``most`` characters with the number of those left."""
    head = printable(text[:most])
    return head if len(text) <= most else f"{head}… ({len(text)} characters)"


def nearest(word: str, known: Iterable[str]) -> str | None:
    """The one of ``known`` that was probably meant, None where none is near.

    Case does not count.  A piece of a name ("pla") is near to it.
    """
    names = {name.casefold(): name for name in reversed(list(known))}
    typed = word[:200].casefold()
    close = difflib.get_close_matches(typed, names, n=1)
    if not close and len(typed) >= _PIECE_MIN:
        close = [name for name in reversed(names) if typed in name][:1]
    return names[close[0]] if close else None


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """The question that a mistyped name is met with, None where no known one is near."""
    close = nearest(word, known)
    return None if close is None else f"Did you mean {close}?"


def _written_out(char: str) -> str:
    return char.encode("unicode_escape").decode("ascii")
