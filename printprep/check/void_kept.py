"""Rule: the model brought sealed voids, which stay."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("void-kept")
def void_kept(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Tells that sealed voids of the model stay, because a body lies in them or on request."""
    del profile
    holding, kept = context.voids.holding_mm3, context.voids.kept_mm3
    if holding:
        total = sum(holding)
        voids = "A void" if len(holding) == 1 else f"{len(holding)} voids"
        stay, hold = ("stays", "it holds") if len(holding) == 1 else ("stay", "they hold")
        yield finding(
            "void-kept",
            f"{voids} of the model, {total / 1000:.3g} cm³, {stay}: {hold} a body of its own, "
            "loose inside.",
            "If nothing loose is meant to be inside, remove that body from the model: the void is "
            "then filled.",
            value=total,
            volume_mm3=total,
        )
    if kept:
        total = sum(kept)
        voids = "A sealed void" if len(kept) == 1 else f"{len(kept)} sealed voids"
        yield finding(
            "void-kept",
            f"{voids} of the model, {total / 1000:.3g} cm³, "
            f"{'stays' if len(kept) == 1 else 'stay'}, as --voids keep asks.",
            value=total,
            volume_mm3=total,
        )
