"""Processors for one worker of several, so that their native threads do not crowd each other.

The libraries below (TBB in manifold3d, OpenMP, BLAS) take as many threads as their process may use
processors, so a worker that is bound to its own has threads for these alone.
"""

from __future__ import annotations

import contextlib
import os
from functools import cache
from pathlib import Path


def usable_processors() -> int:
    """How many processors this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


@cache
def bind(slot: int, slots: int) -> int:
    """Bind this process to its share of the processors; returns how many those are.

    slot : which worker of the machine this is, from 0;  slots : how many there are.  Asked again
    for the same, it leaves what it did.  Where the system cannot bind (macOS, Windows), nothing is
    done.
    """
    if not hasattr(os, "sched_setaffinity"):
        return usable_processors()
    here = sorted(os.sched_getaffinity(0))
    each = max(1, len(here) // slots)
    first = (slot * each) % len(here)
    mine = [here[(first + k) % len(here)] for k in range(each)]
    # Each thread has processors of its own; libraries count those of the first one
    for task in Path("/proc/self/task").iterdir():
        with contextlib.suppress(ProcessLookupError):  # a thread that has just ended
            os.sched_setaffinity(int(task.name), mine)
    return len(mine)
