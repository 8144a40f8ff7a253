"""The drain options: which ones go together, and which profile keys they change."""

from __future__ import annotations

from collections.abc import Mapping

from printprep.errors import UsageError
from printprep.pipeline.options import drain_keys


def drain_options(
    count: int | None, diameter_mm: float | None, no_drains: bool
) -> Mapping[str, object]:
    """The profile keys that --drains, --drain-diameter and --no-drains change.

    Raises UsageError if they contradict each other.
    """
    if no_drains and count is not None:
        raise UsageError("--drains and --no-drains exclude each other.", "Leave out one of them.")
    if no_drains or count == 0:
        if diameter_mm is not None:
            raise UsageError(
                "--drain-diameter has no effect without drain holes.",
                "Leave it out, or request drain holes with --drains N.",
            )
        return {"drain.count": 0}
    return drain_keys(count, diameter_mm)
