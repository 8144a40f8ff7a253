"""The chart of mass over lean as SVG: coordinates only; colours and fonts are the page's."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from printprep.page.content import Curve

WIDTH, HEIGHT = 380, 220
_LEFT, _RIGHT, _TOP, _BOTTOM = 40, 14, 14, 34


@dataclass(frozen=True)
class Tick:
    """A grid line.  at : its x or y;  text : the number beside it."""

    at: float
    text: str


@dataclass(frozen=True)
class Spot:
    """A marked place with its name, to its left or its right."""

    x: float
    y: float
    label: str
    kind: str
    anchor: str
    label_x: float


@dataclass(frozen=True)
class Drawing:
    """What the template draws, in a view box of WIDTH by HEIGHT.

    path : of the curve;  area : under it;  lean_x : where the lean asked for is, None outside.
    """

    path: str
    area: str
    leans: tuple[Tick, ...]
    masses: tuple[Tick, ...]
    spots: tuple[Spot, ...]
    lean_x: float | None
    left: int = _LEFT
    right: int = WIDTH - _RIGHT
    top: int = _TOP
    bottom: int = HEIGHT - _BOTTOM
    width: int = WIDTH
    height: int = HEIGHT


def drawn(curve: Curve) -> Drawing:
    """The drawing of a curve."""
    leans = [lean for lean, _ in curve.points] + [dot.lean_deg for dot in curve.dots]
    masses = [mass for _, mass in curve.points] + [dot.mass_g for dot in curve.dots]
    x_ticks = ticks(min(0.0, *leans), max(*leans, curve.lean_deg, 1.0))
    y_ticks = ticks(0.0, max(masses))

    def x(lean: float) -> float:
        share = (lean - x_ticks[0]) / (x_ticks[-1] - x_ticks[0])
        return round(_LEFT + share * (WIDTH - _LEFT - _RIGHT), 1)

    def y(mass: float) -> float:
        share = (mass - y_ticks[0]) / (y_ticks[-1] - y_ticks[0])
        return round(HEIGHT - _BOTTOM - share * (HEIGHT - _TOP - _BOTTOM), 1)

    line = " ".join(f"{x(lean)},{y(mass)}" for lean, mass in curve.points)
    floor = HEIGHT - _BOTTOM
    area = f"{x(curve.points[0][0])},{floor} {line} {x(curve.points[-1][0])},{floor}"
    spots = []
    for dot in curve.dots:
        right = x(dot.lean_deg) < WIDTH * 0.62
        spots.append(
            Spot(
                x(dot.lean_deg),
                y(dot.mass_g),
                dot.label,
                dot.kind,
                "start" if right else "end",
                round(x(dot.lean_deg) + (9 if right else -9), 1),
            )
        )
    return Drawing(
        path=line,
        area=area,
        leans=tuple(Tick(x(tick), f"{tick:g}°") for tick in x_ticks),
        masses=tuple(Tick(y(tick), f"{tick:g}") for tick in y_ticks),
        spots=tuple(spots),
        lean_x=x(curve.lean_deg),
    )


def ticks(low: float, high: float) -> list[float]:
    """Four to eight round numbers that span low to high."""
    span = max(high - low, 1e-6)
    step = 10.0 ** float(np.floor(np.log10(span)))
    step *= next(factor for factor in (0.2, 0.5, 1.0, 2.0) if span / (step * factor) <= 6)
    first, last = np.floor(low / step + 1e-9), np.ceil(high / step - 1e-9)
    return [float(f"{k * step:.6g}") for k in range(int(first), int(last) + 1)]
