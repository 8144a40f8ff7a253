"""A simulation, for a person at a terminal."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rich.table import Table

from printprep.check.simulated import first_to_tip
from printprep.stand.scene import MOST_LEAN_DEG

if TYPE_CHECKING:
    from printprep.types import Simulation


def simulated(simulation: Simulation) -> str:
    """One line: whether the part stands freely, and the lean at which it tips."""
    settled = simulation.settled
    if not settled.stands:
        return f"falls over: turned by {settled.rotation_deg:.1f}° after {settled.seconds:g} s"
    first = first_to_tip(simulation)
    stands = f"stands for {settled.seconds:g} s (turned by {settled.rotation_deg:.1f}°)"
    if first is None:
        return stands
    return f"{stands}; tips at {angle(first.tips_deg)} toward azimuth {first.azimuth_deg:.0f}°"


def azimuth_table(simulation: Simulation) -> Table:
    """Computed and simulated angles, a row for each azimuth."""
    table = Table(box=None, padding=(0, 2, 0, 0), header_style="dim")
    for head in ("leaning toward", "computed", "foot leaves the bed", "falls over"):
        table.add_column(head, justify="right", no_wrap=True)
    for item in simulation.tippings:
        table.add_row(
            f"{item.azimuth_deg:.0f}°",
            f"{item.computed_deg:.1f}°",
            angle(item.tips_deg),
            angle(item.falls_deg),
        )
    return table


def angle(lean_deg: float | None) -> str:
    """A lean in degrees; None is one beyond the largest that is tried."""
    return f"over {MOST_LEAN_DEG:g}°" if lean_deg is None else f"{lean_deg:.1f}°"
