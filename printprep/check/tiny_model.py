"""Rule: the model is larger than a millimetre."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

LEAST_SIDE_MM = 1.0


@rule("tiny-model")
def tiny_model(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a file in metres, or without a unit, from printing far too small."""
    del profile
    side = max(context.size_mm)
    if side >= LEAST_SIDE_MM:
        return
    yield finding(
        "tiny-model",
        f"The longest side is {side:.3g} mm: the file is probably not in millimetres.",
        f"Name its unit (--units m makes it {1000 * side:.4g} mm) or its size (--size, --scale).",
        value=side,
        limit=LEAST_SIDE_MM,
    )
