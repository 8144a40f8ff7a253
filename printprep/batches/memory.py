"""How much memory a job takes, estimated before it starts: so many run at once as fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.machine_memory import available_mib

if TYPE_CHECKING:
    from printprep.pipeline.job import Job

# Fits to the peak resident memory of whole runs, from above: see docs/cluster.md.
BASE_MIB = 560.0
MIB_PER_1000_TRIANGLES = 2.5
MIB_PER_MILLION_VOXELS = 210.0
# A triangle takes at least so many bytes of a file: binary STL has 50, text has more, a zip less.
BYTES_PER_TRIANGLE = {".3mf": 6.0, ".glb": 12.0, ".npz": 1e9, ".npy": 1e9, ".pt": 1e9}
STL_BYTES = 50.0
# Of the machine's memory, left to all else.
SPARE_SHARE = 0.2


def estimated_mib(job: Job) -> float:
    """Peak memory of a job in MiB, by the size of its file and its resolution."""
    try:
        size = job.model.stat().st_size
    except OSError:
        size = 0
    each = BYTES_PER_TRIANGLE.get(job.model.suffix.lower(), STL_BYTES)
    triangles = size / each
    voxels = float(job.options.resolution) ** 3
    return (
        BASE_MIB + MIB_PER_1000_TRIANGLES * triangles / 1000 + MIB_PER_MILLION_VOXELS * voxels / 1e6
    )


def machine_mib() -> float:
    """Memory that a batch may take of this machine, MiB: most of what is free now."""
    free = available_mib()
    return (1 - SPARE_SHARE) * free if free is not None else 4096.0
