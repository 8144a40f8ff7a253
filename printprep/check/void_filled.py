"""Rule: the model brought sealed voids, which were filled."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("void-filled")
def void_filled(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that sealed voids of the model were filled before it was hollowed."""
    del profile
    filled = context.voids.filled_mm3
    if not filled:
        return
    total = sum(filled)
    voids = "A sealed void" if len(filled) == 1 else f"{len(filled)} sealed voids"
    was, it = ("was", "it") if len(filled) == 1 else ("were", "them")
    yield finding(
        "void-filled",
        f"{voids} of the model, {total / 1000:.3g} cm³, {was} filled before hollowing.",
        f"To keep {it}, use --voids keep.",
        value=total,
        volume_mm3=total,
    )
