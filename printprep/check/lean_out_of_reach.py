"""Rule: the lean asked for is one that some filling of the model reaches."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.registry import rule
from printprep.stand.lean import tilt_toward
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.subject import Subject
    from printprep.profiles import Profile


@rule("lean-out-of-reach")
def lean_out_of_reach(subject: Subject, profile: Profile) -> Iterator[Finding]:
    """Prevents the belief that more ballast would help where only feet or pose can.

    Near the largest lean that any filling reaches the mass explodes, so the part is solved for 0.9
    of it; where even upright is out of reach, no filling helps and the lightest shell is written.
    """
    reachable = subject.reachable_deg
    if reachable is None:
        return
    if reachable > 0:
        message = (
            f"A lean of {subject.lean} is out of reach: no filling of this model stands "
            f"beyond {reachable:.1f}°"
        )
        tilt = tilt_toward(subject.stability, subject.lean)
        message += "." if tilt is None else f"; this part stands to {tilt:.1f}°."
    else:
        message = "No filling makes it stand: its weight lies outside its feet whatever is inside."
    growth = profile.stability.base_growth_max_mm
    yield Finding(
        "lean-out-of-reach",
        "error",
        message,
        "A base (--base auto) or a larger one "
        f"(--set stability.base_growth_max_mm={max(2 * growth, 3):g}), another pose (--up), "
        "or a smaller --lean.",
        value=reachable,
        limit=subject.lean.angle_deg,
        unit="deg",
        at_mm=subject.stability.centre_of_mass_mm,
    )
