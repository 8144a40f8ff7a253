"""Rule: a hollowed part has a cavity."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("nothing-to-hollow")
def nothing_to_hollow(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Explains why a part has no cavity."""
    if not context.hollowed or context.infilled or context.cavities or context.drained:
        return
    yield finding(
        "nothing-to-hollow",
        "The part is solid: the model is thin everywhere, or all of it is needed to stand.",
        f"Scale the model up (--size), or choose a wall thinner than {profile.wall_mm:g} mm "
        "(--wall).",
    )
