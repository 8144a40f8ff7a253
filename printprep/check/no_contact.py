"""Rule: every body of the part touches the bed with its first layer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile


@rule("no-contact")
def no_contact(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents an empty first layer, and a body that starts in mid-air."""
    if context.stability.tilt_deg is not None:
        return
    x, y, z = context.stability.centre_of_mass_mm
    layer = profile.printer.first_layer_mm
    yield finding(
        "no-contact",
        f"A body does not touch the bed in the first layer ({layer:g} mm): it cannot stand.",
        "Seat its feet (`printprep hollow --base always`), turn the part (--up), or join the body "
        "to the others.",
        value=0.0,
        at_mm=(x, y, z),
    )
