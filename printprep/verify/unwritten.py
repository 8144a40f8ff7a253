"""Verify a part before it is written: its file is sliced from a temporary folder."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.files import scratch_folder
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.verify.run import Verified


def check_verifiable(target: Path, profile: Profile) -> None:
    """Check before the long work that a part can be verified.

    Raises UsageError for a target that is not a 3MF or a profile that is not for filament,
    ToolError if there is no slicer.
    """
    from printprep.slicer.process import find_slicer
    from printprep.slicer.prusa_ini import profile_settings

    if target.suffix.lower() != ".3mf":
        raise UsageError(
            f"{target} cannot be verified: only a 3MF carries the settings and figures.",
            "Name an --output that ends in .3mf, or leave out --verify.",
        )
    profile_settings(profile)
    find_slicer()


def verify_result(
    result: HollowResult, *, compare_with: Path | None = None, progress: Progress = SILENT
) -> Verified:
    """Slice the 3MF of ``result`` before it is written, and compare.

    compare_with : the model, to slice it with usual infills too; None for the part alone.

    Raises what :func:`printprep.verify.run.verify` raises.
    """
    from printprep.output.part_file import part_bytes
    from printprep.verify.run import verify

    with scratch_folder() as folder:
        part = folder / "part.3mf"
        part.write_bytes(part_bytes(result.contents(), part.suffix))
        return verify(part, compare_with=compare_with, progress=progress)
