"""Means of each method over the models, and comparisons of two methods."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.evaluate.measured import Measured

# Share of the mass that rounding in a written result may hide.
_SAME = 1e-7


@dataclass(frozen=True)
class Summary:
    """One method over all its models; means except for the counts and the share.

    out_of_reach : models on which no filling reaches the lean asked for.
    """

    method: str
    models: int
    mass: float
    mass_ratio: float
    stable_percent: float
    rotation_deg: float
    tilt_deg: float
    f_score: float
    chamfer: float
    out_of_reach: int
    seconds: float


@dataclass(frozen=True)
class Comparison:
    """One method against another, on the models of both.

    lighter_percent : by how much the mean mass ratio is lower;  stable_points : difference of the
    share that stands, in percentage points;  heavier : the models on which it weighs more;
    fell, rose : the models that stand only with the other, and only with this.
    """

    method: str
    other: str
    models: int
    lighter_percent: float
    stable_points: float
    heavier: tuple[str, ...]
    fell: tuple[str, ...]
    rose: tuple[str, ...]


def summary(method: str, results: Sequence[Measured]) -> Summary | None:
    """The means of one method; None when no model has a result of it."""
    rows = [row for row in results if row.method == method]
    if not rows:
        return None

    def mean(values: Sequence[float]) -> float:
        return float(np.mean(values))

    return Summary(
        method=method,
        models=len(rows),
        mass=mean([row.mass for row in rows]),
        mass_ratio=mean([row.mass_ratio for row in rows]),
        stable_percent=100 * mean([row.stands for row in rows]),
        rotation_deg=mean([row.rotation_deg for row in rows]),
        tilt_deg=mean([row.tilt_deg for row in rows]),
        f_score=mean([row.f_score for row in rows]),
        chamfer=mean([row.chamfer for row in rows]),
        out_of_reach=sum(row.reachable_deg is not None for row in rows),
        seconds=mean([row.seconds for row in rows]),
    )


def compare(method: str, other: str, results: Sequence[Measured]) -> Comparison | None:
    """Compare one method with another; None when no model has both."""
    ours = {row.model: row for row in results if row.method == method}
    pairs = [(ours[row.model], row) for row in results if row.method == other and row.model in ours]
    if not pairs:
        return None
    light = float(np.mean([mine.mass_ratio for mine, _ in pairs]))
    heavy = float(np.mean([theirs.mass_ratio for _, theirs in pairs]))
    stands = sum(int(mine.stands) - int(theirs.stands) for mine, theirs in pairs)
    return Comparison(
        method=method,
        other=other,
        models=len(pairs),
        lighter_percent=100 * (1 - light / heavy),
        stable_points=100 * stands / len(pairs),
        heavier=tuple(a.model for a, b in pairs if a.mass > b.mass * (1 + _SAME)),
        fell=tuple(a.model for a, b in pairs if b.stands and not a.stands),
        rose=tuple(a.model for a, b in pairs if a.stands and not b.stands),
    )
