"""Rule: the file is a solid without a repair."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding, Severity

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A printed layer hides less than this.
_MOVED_LIMIT_MM = 0.1


@rule("repaired")
def repaired(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from guessing what is inside an open or self-intersecting surface.

    For a file as it came, it tells that a repaired solid was checked instead: a warning where holes
    were closed or the surface was remeshed, information where shells were only united or turned.
    Other rules name the faults of the file itself.  For a part that printprep made, it tells of a
    repair only where the surface moved by more than a layer hides.
    """
    del profile
    repair = context.repair
    if repair.rung == "as-is" or (context.hollowed and repair.moved_max_mm <= _MOVED_LIMIT_MM):
        return
    moved_mm = round(repair.moved_max_mm, 4)  # less is rounding, not repair
    actions = "; ".join(action.rstrip(".") for action in repair.actions) or repair.rung
    moved = f"moved its surface by up to {moved_mm:.2g} mm" if moved_mm else "did not move it"
    if context.hollowed:
        severity: Severity = "warning"
        message = f"The model was repaired, which {moved} ({actions})."
        fix = "Look at the part before printing it, or repair the model in the program it is from."
    else:
        severity = "info" if repair.rung == "union" else "warning"
        message = f"The file was repaired before it was checked, which {moved} ({actions})."
        fix = "`printprep hollow` does the same repair and writes the repaired part."
    yield finding(
        "repaired",
        message,
        fix,
        severity=severity,
        value=moved_mm,
        limit=_MOVED_LIMIT_MM if context.hollowed else 0.0,
    )
