"""The printing processes: one row each, read wherever a rule depends on how a part is made.

A fourth process is one more row in ``PROCESSES`` and a profile that names it.
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Process:
    """What a process does to a part, as far as hollowing and checking depend on it.

    name : the profile key ``process``.
    has_nozzle : it lays lines, so a profile needs nozzle, line width and column slenderness, may
        have infill, and PrusaSlicer's .ini fits it.
    ceilings_sag : a ceiling needs something below it, so cavities get vaults.
    cavity_holds : what stays in a sealed cavity, in words.
    must_drain : that matters: the cavity needs drain holes.
    leaves_pools : what is inside is liquid and stands in pools as the part stands.
    peels_from_film : each layer is pulled off a film, so a closed cup sucks at it.
    loosens_from_bed : nothing but its foot holds the part, so a small one comes loose.
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
