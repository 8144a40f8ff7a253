"""The options for drains: which go together, and what they change of the profile."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import UsageError

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.types import Drainage, Finding


def drain_options(
    count: int | None, diameter_mm: float | None, no_drains: bool
) -> Mapping[str, object]:
    """The profile keys that --drains, --drain-diameter and --no-drains change.

    Raises UsageError where they contradict each other.
    """
    if no_drains and count is not None:
        raise UsageError("--drains and --no-drains exclude each other.", "Leave one out.")
    if no_drains or count == 0:
        if diameter_mm is not None:
            raise UsageError(
                "There is no drain to give a diameter to.",
                "Leave --drain-diameter out, or ask for drains with --drains N.",
            )
        return {"drain.count": 0}
    keys = {"drain.count": count, "drain.diameter_mm": diameter_mm}
    return {key: value for key, value in keys.items() if value is not None}


def check_drains(profile: Profile, diameter_mm: float | None, plugs: Path | None) -> None:
    """Refuse a diameter or plugs for drains that there are none of.

    Raises UsageError.
    """
    if profile.drain.count or (diameter_mm is None and plugs is None):
        return
    asked = "--plugs has nothing to plug" if plugs is not None else "--drain-diameter has no drain"
    raise UsageError(
        f"{asked}: without drains (profile {profile.name}).",
        "Ask for drains with --drains N, or take a profile for resin or powder.",
    )


def check_plugs_output(plugs: Path, target: Path, model: Path) -> None:
    """Find out before the long work whether plugs can be written.

    Raises UsageError for another suffix than .3mf, and for a file that is the part's or the model's
    own.
    """
    from printprep.output.part_file import check_output

    if plugs.suffix.lower() != ".3mf":
        raise UsageError(f"{plugs}: plugs are written as .3mf.", "Name a file that ends in .3mf.")
    check_output(plugs)
    for other, what in ((target, "the part"), (model, "the model")):
        if plugs.resolve() == other.resolve():
            raise UsageError(
                f"{plugs} is {what} itself and would be replaced.", "Name another file for --plugs."
            )


def plug_findings(found: Drainage | None, plugs: Path) -> tuple[Finding, ...]:
    """That there is nothing to plug, so that no file is looked for."""
    from printprep.types import Finding

    if found is not None and found.drains:
        return ()
    message = f"{plugs} was not written: the part has no drains."
    return (Finding("no-plugs", "info", message),)
