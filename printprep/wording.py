"""Small pieces of sentences that several messages need."""

from __future__ import annotations


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


def _written_out(char: str) -> str:
    return char.encode("unicode_escape").decode("ascii")
