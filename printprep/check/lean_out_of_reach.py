"""Rule: the lean asked for is one that some filling of the model reaches."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.stand.lean import tilt_toward
from printprep.types import Advice, Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("lean-out-of-reach")
def lean_out_of_reach(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents the belief that more ballast would help where only feet or pose can.

    Near the largest lean that any filling reaches the mass explodes, so the part is solved for 0.9
    of it; where even upright is out of reach, no filling helps and the lightest shell is written.
    """
    reachable = context.reachable_deg
    if reachable is None:
        return
    if reachable > 0:
        message = (
            f"A lean of {context.lean} is out of reach: no filling of this model stands "
            f"beyond {reachable:.1f}°"
        )
        tilt = tilt_toward(context.stability, context.lean)
        message += "." if tilt is None else f"; this part stands to {tilt:.1f}°."
    else:
        message = "No filling makes it stand: its weight lies outside its feet whatever is inside."
    del profile
    yield finding(
        "lean-out-of-reach",
        message,
        _ways_out(context.advice),
        value=reachable,
        limit=context.lean.angle_deg,
        at_mm=context.stability.centre_of_mass_mm,
    )


def _ways_out(advice: Advice | None) -> str:
    """What would help, with figures where they are known."""
    ways = []
    if advice is not None and advice.growth_mm is not None:
        ways.append(
            f"a footprint grown by {advice.growth_mm:g} mm "
            f"(--base auto --set stability.base_growth_max_mm={advice.growth_mm:g})"
        )
    if advice is not None and advice.poses_deg:
        ways.append(
            f"a pose it stands in by itself (--pose 1: to {advice.poses_deg[0]:.0f}°, solid; "
            f"{len(advice.poses_deg)} known)"
        )
    ways.append("another axis up (--up)")
    ways.append("a smaller --lean")
    return f"What helps: {'; '.join(ways)}."
