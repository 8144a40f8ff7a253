"""Rule: the file was a solid before anything was done to it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding, Severity

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# What a printed layer hides.
_MOVED_LIMIT_MM = 0.1


@rule("repaired")
def repaired(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents a slicer from guessing what an open or tangled surface means.

    On a file as it came it tells what was judged instead of it: warning where holes were closed or
    the surface remade, information where only shells were joined or turned; what is wrong with the
    file itself has rules of its own.  On a part of ours the repair is done, and worth a word only
    where it moved the surface by more than a layer hides.
    """
    del profile
    repair = context.repair
    if repair.rung == "as-is" or (context.hollowed and repair.moved_max_mm <= _MOVED_LIMIT_MM):
        return
    moved_mm = round(repair.moved_max_mm, 4)  # below that it is arithmetic, not repair
    done = "; ".join(action.rstrip(".") for action in repair.actions) or repair.rung
    moved = f"the surface moved by up to {moved_mm:.2g} mm" if moved_mm else "nothing moved"
    if context.hollowed:
        severity: Severity = "warning"
        message = f"The model had to be repaired, and {moved} ({done})."
        fix = "Look at the part before printing it, or repair the model where it was made."
    else:
        severity = "info" if repair.rung == "union" else "warning"
        message = f"The file was judged as a solid; making it one took: {done} ({moved})."
        fix = "`printprep hollow` does the same repair and writes a sound part."
    yield finding(
        "repaired",
        message,
        fix,
        severity=severity,
        value=moved_mm,
        limit=_MOVED_LIMIT_MM if context.hollowed else 0.0,
    )
