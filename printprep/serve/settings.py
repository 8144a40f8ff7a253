"""The settings that a page sends, checked and as a job."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from printprep.errors import UsageError
from printprep.pipeline.fills import FILLS
from printprep.pipeline.job import Job

FIELDS = ("wall", "lean", "fill", "drains", "pose")
_LONGEST = 40


@dataclass(frozen=True)
class Settings:
    """What a person can change on the page, as text; empty takes what the command named.

    wall : mm;  lean : degrees, or degrees@azimuth;  fill : a name in FILLS;  drains : least number
    of holes in each cavity;  pose : number of a stable pose.
    """

    wall: str = ""
    lean: str = ""
    fill: str = "cavity"
    drains: str = ""
    pose: str = ""

    @classmethod
    def of(cls, data: object) -> Settings:
        """From the JSON of a page.  Raises UsageError for anything but short texts."""
        if not isinstance(data, Mapping):
            raise UsageError("The settings are not a table of texts.")
        unknown = sorted(str(key) for key in data if key not in FIELDS)
        if unknown:
            raise UsageError(f"There is no setting {unknown[0][:_LONGEST]}.")
        for key, value in data.items():
            if not isinstance(value, str) or len(value) > _LONGEST:
                raise UsageError(f"{key} is not a short text.")
        return cls(**{key: value.strip() for key, value in data.items()})

    def job(self, template: Job) -> Job:
        """The job with these settings.  Raises UsageError that names the setting."""
        if self.fill not in FILLS:
            raise UsageError(f"There is no fill {self.fill}.", f"Use {' or '.join(FILLS)}.")
        changed: dict[str, object] = dict(template.overrides)
        if self.wall:
            changed["wall_mm"] = _number("wall", self.wall)
        if self.drains:
            changed["drain.count"] = _whole("drains", self.drains)
        pose = _whole("pose", self.pose) if self.pose else template.placement.pose
        lean: Any = self.lean or template.options.lean
        return replace(
            template,
            overrides=changed,
            placement=replace(template.placement, pose=pose),
            options=replace(template.options, fill=self.fill, lean=lean),
        )

    def command(self, model: str, profile: str) -> str:
        """The command line that does the same, but for the options that the server was given."""
        words = ["printprep", "hollow", model, "-p", profile]
        for option, value in (
            ("--wall", self.wall),
            ("--lean", self.lean),
            ("--fill", self.fill if self.fill != "cavity" else ""),
            ("--drains", self.drains),
            ("--pose", self.pose),
        ):
            words += [option, value] if value else []
        return shlex.join(words)


def _number(name: str, text: str) -> float:
    try:
        return float(text.replace(",", "."))
    except ValueError:
        raise UsageError(f"{name} is not a number: {text}.") from None


def _whole(name: str, text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise UsageError(f"{name} is not a whole number: {text}.") from None
