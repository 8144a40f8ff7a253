"""The options of a run as frozen values, which a command, a batch or a service can pass on."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from printprep.errors import UsageError
from printprep.objectives import DEFAULT_OBJECTIVE, Solver

if TYPE_CHECKING:
    from collections.abc import Mapping

    from printprep.density.program import BasePolicy
    from printprep.types import Lean, VaultChoice

VoidPolicy = Literal["fill", "keep"]

FINEST, COARSEST = 512, 8  # voxels along the longest side


@dataclass(frozen=True)
class Placement:
    """How a model is placed on the bed.

    units : unit of the file: mm, cm, m or in; None takes the one named in the file, or mm.
    up : axis of the file that points up.
    scale, height_mm, size_mm : at most one: a factor, the height, or the longest side.
    pose : K puts the placed model into its K-th steadiest stable pose.
    partial : take the facets that are there from a file that is cut short.
    plate : number of the plate of a 3MF project to read.
    item : name or number of the one object of a 3MF to read.
    """

    units: str | None = None
    up: str = "+z"
    scale: float | None = None
    height_mm: float | None = None
    size_mm: float | None = None
    pose: int | None = None
    partial: bool = False
    plate: int | None = None
    item: str | None = None


AS_IN_FILE = Placement()


@dataclass(frozen=True)
class FillOptions:
    """How the inside is decided.

    fill : a name in :data:`printprep.pipeline.fills.FILLS`.
    lean : degrees at which the part must stand, "15@90" for 15° toward azimuth 90°, None for the
        profile's.
    resolution : voxels along the longest side.
    objective, solver : a name in :data:`printprep.objectives.OBJECTIVES`, and how it is solved.
    base : whether material may be added around the feet.
    voids : whether the model's own sealed voids are filled before hollowing, or stay.
    vaults : whose overhang rule the vaults keep that carry ceilings: "printer", which counts on a
        support blocker in the file, or "slicer"; "none" for no vaults.  None takes the printer's
        where ceilings sag in the profile's process, and the slicer's without a blocker.
    blocker : whether a support blocker is made; the file must be able to carry it.
    slicer : the PrusaSlicer that weighs infill prints.  None uses the one installed; without one
        the print is estimated.
    max_memory_mib : a model whose estimate exceeds this is refused; None: what the machine has
        free.
    """

    fill: str = "cavity"
    lean: float | str | Lean | None = None
    resolution: int = 64
    objective: str = DEFAULT_OBJECTIVE
    solver: Solver = field(default_factory=Solver)
    base: BasePolicy = "auto"
    voids: VoidPolicy = "fill"
    vaults: VaultChoice | None = None
    blocker: bool = True
    slicer: Path | None = None
    max_memory_mib: float | None = None


def drain_keys(count: int | None, diameter_mm: float | None) -> Mapping[str, object]:
    """The profile keys that change the drains; None leaves the profile's."""
    keys = {"drain.count": count, "drain.diameter_mm": diameter_mm}
    return {key: value for key, value in keys.items() if value is not None}


def check_resolution(resolution: int) -> None:
    """Raise UsageError for a resolution that is too coarse or too fine."""
    if not COARSEST <= resolution <= FINEST:
        raise UsageError(
            f"A resolution of {resolution} is not between {COARSEST} and {FINEST} voxels.",
            "The default, 64, suits most models; walls are exact at any resolution.",
        )
