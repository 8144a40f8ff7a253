"""Limits that are checked before any work: the size of a model, and the memory that it takes."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import GeometryError, InputError, UsageError
from printprep.machine_memory import available_mib

if TYPE_CHECKING:
    from printprep.pipeline.options import Placement
    from printprep.profiles import Profile
    from printprep.types import Model

# A model longer than this many beds is in another unit, or damaged.
MOST_BEDS = 10.0

# Upper bounds of peak resident memory, from whole runs (docs/cluster.md): libraries, a triangle
# with its share of the part, a voxel of the optimization, a cell of the finer grid at the wall, and
# the grids on which holes are placed and pools found, which are bounded by themselves.
BASE_MIB = 420.0
TRIANGLE_BYTES = 2500.0
VOXEL_BYTES = 220.0
FINE_BYTES = 12.0
FINE_CELLS_PER_WALL, MOST_FINE_CELLS = 3.0, 384.0
DRAIN_CELLS, DRAIN_CELL_BYTES = 16e6, 40.0
# Of the memory that is free, left to all else.
SPARE_SHARE = 0.1


def check_size(model: Model, profile: Profile, placement: Placement) -> None:
    """Check that a placed model has a size that a printer can know.

    Raises
    ------
    UsageError : an option gave the size.
    GeometryError : the file did.
    """
    extents = np.ptp(model.vertices, axis=0)
    longest, least = float(extents.max()), profile.printer.layer_height_mm
    bed = max(profile.printer.bed_mm)
    if longest > MOST_BEDS * bed:
        times = f"{longest / bed:.3g} times the longest side of the bed ({bed:g} mm)"
        fact = f"{model.name} would be {length(longest)} long, {times}."
    elif longest < least:
        fact = f"{model.name} would be {length(longest)} long, less than one layer ({least:g} mm)."
    else:
        return
    given = {"--scale": placement.scale, "--height": placement.height_mm}
    given["--size"] = placement.size_mm
    for option, value in given.items():
        if value is not None:
            raise UsageError(f"With {option} {value:g}, {fact}", "Give another size.")
    raise GeometryError(
        fact.replace("would be", "is"),
        "Name the unit of the file (--units), or give the model a size (--size).",
    )


def length(mm: float) -> str:
    """A length in words: m where mm would be many digits."""
    return f"{mm / 1000:.6g} m" if mm >= 10_000 else f"{mm:.4g} mm"


def margin_mm(longest_mm: float, profile: Profile) -> float:
    """Margin of the grid around a model in x and y, for a base that grows; no wider than itself."""
    return min(float(profile.stability.base_growth_max_mm), longest_mm)


def estimated_mib(
    triangles: int, extents_mm: tuple[float, float, float], profile: Profile, resolution: int
) -> float:
    """Most memory that a run takes, MiB, from above.

    resolution : voxels along the longest side; 0 for a run that hollows nothing.
    """
    longest = max(extents_mm)
    bytes_ = TRIANGLE_BYTES * triangles
    if resolution:
        margin = 2 * margin_mm(longest, profile)
        pitch = longest / resolution
        x, y, z = extents_mm
        bytes_ += (
            VOXEL_BYTES * ((x + margin) / pitch + 1) * ((y + margin) / pitch + 1) * (z / pitch)
        )
        cell = max(profile.wall_mm / FINE_CELLS_PER_WALL, longest / MOST_FINE_CELLS)
        # The cells are a whole part of a voxel: up to half as small again.
        bytes_ += FINE_BYTES * math.prod(1.5 * side / cell + 1 for side in extents_mm)
    if profile.traits.must_drain:
        bytes_ += DRAIN_CELL_BYTES * DRAIN_CELLS
    return BASE_MIB + bytes_ / (1 << 20)


def check_memory(
    model: Model, profile: Profile, resolution: int, max_memory_mib: float | None
) -> None:
    """Check that a run fits into memory.

    max_memory_mib : None for what this machine has free, less a tenth.

    Raises
    ------
    InputError : it takes more.
    """
    if max_memory_mib is None:
        free = available_mib()
        if free is None:
            return
        limit, whose = (1 - SPARE_SHARE) * free, "this machine has free"
    else:
        limit, whose = max_memory_mib, "--max-memory allows"
    x, y, z = np.ptp(model.vertices, axis=0).tolist()
    needed = estimated_mib(len(model.faces), (x, y, z), profile, resolution)
    if needed <= limit:
        return
    base = estimated_mib(len(model.faces), (x, y, z), profile, 0)
    hint = (
        f"Choose a coarser grid (--resolution, now {resolution}), or allow more (--max-memory)."
        if base <= limit
        else "Reduce its triangles in a modelling program, or allow more (--max-memory)."
    )
    raise InputError(
        f"{model.name} ({len(model.faces)} triangles) would take about {needed:.0f} MiB of memory, "
        f"more than the {limit:.0f} MiB that {whose}.",
        hint,
    )
