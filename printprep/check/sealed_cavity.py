"""Rule: what is shut inside a part with no way out."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.registry import rule
from printprep.mesh.measure import shells
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

_TRAPS = {"fdm": "air", "resin": "liquid resin", "powder": "powder"}


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
    harmless = profile.process == "fdm"
    fix = (
        "Drill a drain and a vent into each (`printprep hollow` does, given the solid model), or"
        " print it with a process that leaves only air."
    )
    yield Finding(
        "sealed-cavity",
        "info" if harmless else "error",
        f"{count} {total_mm3 / 1000:.3g} cm³ of {_TRAPS[profile.process]}.",
        None if harmless else fix,
        value=total_mm3,
        limit=None if harmless else 0.0,
        unit="mm3",
        at_mm=(x, y, z),
    )
