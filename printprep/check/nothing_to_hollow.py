"""Rule: the part that was to be hollowed is hollow."""

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
    """Prevents the surprise of a part that weighs what it did before."""
    if not context.hollowed or context.infilled or context.cavities:
        return
    yield finding(
        "nothing-to-hollow",
        "There is no cavity: the model is thin everywhere, or all of it is needed to stand. "
        "The part is solid.",
        f"A larger model (--size) or a thinner wall than {profile.wall_mm:g} mm (--wall) "
        "leaves more room.",
    )
