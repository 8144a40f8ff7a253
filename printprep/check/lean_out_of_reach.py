"""Rule: some filling of the model stands at the requested lean."""

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
    """Prevents attempts with more ballast where only larger feet or another pose help.

    Close to the largest lean that any filling reaches, the mass grows without limit, so the part is
    solved for 0.9 of that lean.  Where no filling stands upright, the lightest shell is written.
    """
    del profile
    reachable = context.reachable_deg
    if reachable is None:
        return
    if reachable > 0:
        message = (
            f"A lean of {context.lean} is out of reach: no filling of this model stands beyond "
            f"{reachable:.1f}°"
        )
        tilt = tilt_toward(context.stability, context.lean)
        message += "." if tilt is None else f"; this part tips over at {tilt:.1f}°."
    else:
        message = (
            "No filling makes the part stand: whatever fills it, its centre of mass lies outside "
            "its support polygon."
        )
    yield finding(
        "lean-out-of-reach",
        message,
        _ways_out(context.advice),
        value=reachable,
        limit=context.lean.angle_deg,
        at_mm=context.stability.centre_of_mass_mm,
    )


def _ways_out(advice: Advice | None) -> str:
    """What would make it stand, with figures where they are known."""
    ways = []
    if advice is not None and advice.growth_mm is not None:
        ways.append(
            f"a footprint grown by {advice.growth_mm:g} mm "
            f"(--base auto --set stability.base_growth_max_mm={advice.growth_mm:g})"
        )
    if advice is not None and advice.poses_deg:
        ways.append(
            f"one of its {len(advice.poses_deg)} stable poses (--pose 1 stands to "
            f"{advice.poses_deg[0]:.0f}° when solid)"
        )
    ways.append("another axis up (--up)")
    ways.append("a smaller lean (--lean)")
    return f"Choose one: {'; '.join(ways)}."
