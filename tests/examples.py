"""How many examples a property gets that takes longer than most."""

from __future__ import annotations

from hypothesis import settings

_USUAL = 100


def examples(count: int) -> settings:
    """``count`` examples by default, and more in the proportion that a profile asks for more."""
    return settings(max_examples=count * settings.default.max_examples // _USUAL)
