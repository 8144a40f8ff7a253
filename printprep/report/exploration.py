"""An exploration as JSON and as a table."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from printprep.output.numbers import number
from printprep.version import __version__

if TYPE_CHECKING:
    from rich.console import Console

    from printprep.pipeline.explore import Exploration, Point


def exploration_json(found: Exploration, *, model: str) -> dict[str, Any]:
    """The curve and its marks as plain values; masses in g, angles in degrees."""
    return {
        "printprep": __version__,
        "model": model,
        "profile": found.profile.name,
        "reachable_deg": number(found.reachable_deg),
        "curve": [
            {
                "lean_deg": number(point.lean_deg),
                "mass_g": number(point.mass_g),
                "base_growth_mm": number(point.growth_mm),
                "gap": number(point.gap),
            }
            for point in found.points
        ],
        "marks": [
            {"name": mark.name, "mass_g": number(mark.mass_g), "tilt_deg": number(mark.tilt_deg)}
            for mark in found.marks
        ],
    }


def show_exploration(console: Console, found: Exploration) -> None:
    """Print a row for every lean, then the parts to compare with."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD)
    for title in ("stands at", "least mass"):
        table.add_column(title, justify="right")
    table.add_column("base")
    for point in found.points:
        table.add_row(f"{point.lean_deg:.1f}°", f"{point.mass_g:.1f} g", _base(point))
    console.print(table)
    if not found.points:
        console.print(
            f"No filling makes the part stand: the best one tips at {found.reachable_deg:.1f}°.\n"
        )
    for mark in found.marks:
        tips = "no contact" if mark.tilt_deg is None else f"tips at {mark.tilt_deg:.1f}°"
        console.print(f"{mark.name}: {mark.mass_g:.1f} g, {tips}")


def _base(point: Point) -> str:
    if point.growth_mm is None:
        return "none"
    return f"seat, grown by {point.growth_mm:g} mm" if point.growth_mm else "seat"
