"""Rule: the part fits into the printer."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.check.registry import rule
from printprep.types import Finding

if TYPE_CHECKING:
    from printprep.check.context import CheckContext
    from printprep.profiles import Profile

# A part exactly as large as the bed still fits after rounding to float32.
_SLACK = 1 + 1e-6
# A part this many times too large is probably in another unit.
_WRONG_UNIT = 10.0


@rule("fits-bed")
def fits_bed(context: CheckContext, profile: Profile) -> Iterator[Finding]:
    """Prevents slicing a part that does not fit into the printer.

    A part that fits after a quarter turn on the bed fits: slicers turn it.
    """
    size, bed = context.size_mm, profile.printer.bed_mm
    turned = (size[1], size[0], size[2])
    best = min((size, turned), key=lambda sides: _excess(sides, bed))
    excess = _excess(best, bed)
    if excess <= _SLACK:
        return
    axis = max(range(3), key=lambda index: best[index] / bed[index])
    yield finding(
        "fits-bed",
        f"The part measures {_sides(size)} mm; the printer holds {_sides(bed)} mm.",
        _way_out(size, bed, excess),
        value=best[axis],
        limit=bed[axis],
    )


def _way_out(size: Sequence[float], bed: Sequence[float], excess: float) -> str:
    fitting = math.floor(10 * max(size) / excess) / 10
    if excess > _WRONG_UNIT:
        return (
            "The file may be in another unit: name it with --units, or scale the model "
            f"(--scale; --size {fitting:g} fits)."
        )
    if _excess(sorted(size), sorted(bed)) <= _SLACK:
        return f"Lay the part down (--up), or make it smaller (--size {fitting:g} fits)."
    return f"Make it smaller (--size {fitting:g} fits), or choose a profile of a larger printer."


def _excess(size: Sequence[float], bed: Sequence[float]) -> float:
    return max(side / limit for side, limit in zip(size, bed, strict=True))


def _sides(sides: Sequence[float]) -> str:
    return " × ".join(f"{side:.4g}" for side in sides)
