"""Rule: what is shut inside a part with no way out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.mesh.measure import shells
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("sealed-cavity")
def sealed_cavity(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a part that carries its weight in resin or powder for ever, or bursts in the cure.

    Counts every void, the model's own too.  With filament only air stays inside: information.
    """
    _, voids = shells(context.part)
    if not voids:
        return
    largest = max(voids, key=lambda void: void.volume())
    x, y, z = np.reshape(largest.bounding_box(), (2, 3)).mean(axis=0).tolist()
    total_mm3 = float(sum(void.volume() for void in voids))
    count = "A sealed cavity holds" if len(voids) == 1 else f"{len(voids)} sealed cavities hold"
    harmless = not profile.traits.must_drain
    fix = (
        "Drill a drain and a vent into each (`printprep hollow` does, given the solid model), or"
        " print it with a process that leaves only air."
    )
    yield finding(
        "sealed-cavity",
        f"{count} {total_mm3 / 1000:.3g} cm³ of {profile.traits.cavity_holds}.",
        None if harmless else fix,
        severity="info" if harmless else "error",
        value=total_mm3,
        limit=None if harmless else 0.0,
        at_mm=(x, y, z),
    )
