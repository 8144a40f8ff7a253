"""Quotes lines of G-code in errors."""

from __future__ import annotations


def shortened(line: bytes) -> str:
    """A line to quote in an error: at most 60 characters."""
    text = line[:61].decode("ascii", "replace")
    return f"{text[:60]}…" if len(text) > 60 else text
