"""The printing processes, one row each, for everything that depends on how a part is made.

To add one, put a row into ``PROCESSES`` and name it in a profile.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Process:
    """The traits of a process that hollowing and checking depend on.

    name : the value of the profile key ``process``.
    has_nozzle : it prints lines, so a profile needs nozzle, line width and column slenderness, may
        have infill, and can be exported as PrusaSlicer's .ini.
    ceilings_sag : a ceiling needs support from below, so cavities get vaults.
    cavity_holds : what stays in a sealed cavity, as a word in messages.
    must_drain : it must not stay inside, so cavities need drain holes.
    leaves_pools : it is liquid, so pools stand in the part.
    peels_from_film : each layer is peeled off a film, so suction cups matter.
    loosens_from_bed : only the first layer holds the part, so one with little contact comes loose.
    """

    name: str
    has_nozzle: bool
    ceilings_sag: bool
    cavity_holds: str
    must_drain: bool
    leaves_pools: bool
    peels_from_film: bool
    loosens_from_bed: bool


PROCESSES: dict[str, Process] = {
    row.name: row
    for row in (
        Process(
            name="fdm",
            has_nozzle=True,
            ceilings_sag=True,
            cavity_holds="air",
            must_drain=False,
            leaves_pools=False,
            peels_from_film=False,
            loosens_from_bed=True,
        ),
        Process(
            name="resin",
            has_nozzle=False,
            ceilings_sag=False,
            cavity_holds="resin",
            must_drain=True,
            leaves_pools=True,
            peels_from_film=True,
            loosens_from_bed=False,
        ),
        Process(
            name="powder",
            has_nozzle=False,
            ceilings_sag=False,
            cavity_holds="powder",
            must_drain=True,
            leaves_pools=False,
            peels_from_film=False,
            loosens_from_bed=False,
        ),
    )
}
