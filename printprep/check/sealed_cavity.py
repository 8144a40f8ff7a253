"""Rule: cavities without a way out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.points import mean_point
from printprep.check.registry import rule
from printprep.mesh.measure import shells
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("sealed-cavity")
def sealed_cavity(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a part that keeps resin or powder inside for good, or bursts as the resin cures.

    It counts every void, also those of the model.  With filament only air stays inside, so it is
    information.
    """
    _, voids = shells(context.part)
    if not voids:
        return
    largest = max(voids, key=lambda void: void.volume())
    middle = mean_point(np.reshape(largest.bounding_box(), (2, 3)))
    total_mm3 = float(sum(void.volume() for void in voids))
    count = "A sealed cavity holds" if len(voids) == 1 else f"{len(voids)} sealed cavities hold"
    harmless = not profile.traits.must_drain
    fix = (
        "Drill a drain hole and a vent into each, or run `printprep hollow` on the solid model: it "
        "adds them."
    )
    yield finding(
        "sealed-cavity",
        f"{count} {total_mm3 / 1000:.3g} cm³ of {profile.traits.cavity_holds}.",
        None if harmless else fix,
        severity="info" if harmless else "error",
        value=total_mm3,
        limit=None if harmless else 0.0,
        at_mm=middle,
    )
