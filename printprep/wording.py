"""Small pieces of sentences that several messages need."""

from __future__ import annotations


def counted(number: int, noun: str) -> str:
    """A number with its noun ("1 shell", "2 shells"), for nouns whose plural ends in s."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"
