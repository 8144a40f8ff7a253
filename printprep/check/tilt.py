"""Rule: the part stands at the requested lean."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.stand.lean import tilt_toward
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("tilt")
def tilt(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a part that falls over on the shelf, or on the bed while it prints.

    It is silent where there is no contact: another rule tells that.
    """
    del profile
    tilt_deg = tilt_toward(context.stability, context.lean)
    if tilt_deg is None or tilt_deg >= context.lean.angle_deg:
        return
    if tilt_deg < 0:
        message = f"The part tips over by itself (tilt angle {tilt_deg:.1f}°)"
    else:
        message = f"The part tips over at {tilt_deg:.1f}°"
    if context.hollowed:
        fix = "Give it a base (--base always), or another pose (--pose, --up)."
    else:
        fix = (
            "Hollow the solid model with printprep, or give it a larger base or another pose "
            "(--up)."
        )
    yield finding(
        "tilt",
        f"{message}; it should stand at {context.lean}.",
        fix,
        value=tilt_deg,
        limit=context.lean.angle_deg,
        at_mm=context.stability.centre_of_mass_mm,
    )
