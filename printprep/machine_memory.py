"""How much memory this machine, its container and this process's own limit leave."""

from __future__ import annotations

import os
from pathlib import Path

# Where the limits of control groups stand, version 2 and 1.
_LIMITS = (
    "/sys/fs/cgroup/memory.max",
    "/sys/fs/cgroup/memory/memory.limit_in_bytes",
)


def available_mib() -> float | None:
    """Memory that a process can take now, MiB; None where the system does not tell."""
    known = [value for value in (_free_mib(), _group_mib(), _process_mib()) if value is not None]
    return min(known, default=None)


def _free_mib() -> float | None:
    try:
        with Path("/proc/meminfo").open(encoding="ascii") as lines:
            for line in lines:
                if line.startswith("MemAvailable:"):
                    return int(line.split()[1]) / 1024
    except (OSError, ValueError):
        pass
    try:
        return os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / (1 << 20)
    except (AttributeError, ValueError, OSError):
        return None


def _group_mib() -> float | None:
    """The container's limit, as far as one is set."""
    for name in _LIMITS:
        try:
            return int(Path(name).read_text(encoding="ascii")) / (1 << 20)
        except (OSError, ValueError):  # no such file, or "max"
            continue
    return None


def _process_mib() -> float | None:
    """What ``ulimit -v`` allows."""
    try:
        import resource
    except ImportError:  # not on Windows
        return None
    soft, _ = resource.getrlimit(resource.RLIMIT_AS)
    return None if soft == resource.RLIM_INFINITY else soft / (1 << 20)
