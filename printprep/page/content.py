"""What a page says, as frozen text values; ``document.py`` puts them into HTML."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from printprep.types import Severity

Tone = Literal["good", "warn", "bad", "plain"]


@dataclass(frozen=True)
class Fact:
    """One figure with its name.  note : what it means or where it comes from."""

    label: str
    value: str
    note: str | None = None
    tone: Tone = "plain"


@dataclass(frozen=True)
class Group:
    """Facts under a heading.  note : a sentence under them."""

    title: str
    facts: tuple[Fact, ...]
    note: str | None = None


@dataclass(frozen=True)
class FindingRow:
    """A finding as a person reads it.

    number : its place among the findings that the viewer can fly to, None where it has no place.
    """

    severity: Severity
    rule: str
    message: str
    fix: str | None
    number: int | None


@dataclass(frozen=True)
class PoseRow:
    """A stable pose.  number : from 1, the steadiest;  lean_ok : whether it stands at the lean."""

    number: int
    tilt: str
    lean_ok: bool


@dataclass(frozen=True)
class Dot:
    """A marked place of a chart: lean in degrees, mass in g, its name."""

    lean_deg: float
    mass_g: float
    label: str
    kind: Literal["part", "solid"]


@dataclass(frozen=True)
class Curve:
    """Mass over lean.

    points : (lean in degrees, mass in g), by lean;  dots : marked parts.
    lean_deg : the lean at which the part should stand;  note : what all points have in common.
    """

    points: tuple[tuple[float, float], ...]
    dots: tuple[Dot, ...]
    lean_deg: float
    note: str


@dataclass(frozen=True)
class Form:
    """The settings of a served page, as text for its fields; poses as (number, label)."""

    wall_mm: str
    lean: str
    fill: str
    fills: tuple[tuple[str, str], ...]
    drains: str
    pose: str
    poses: tuple[tuple[str, str], ...]
    can_download: bool
    download_name: str


@dataclass(frozen=True)
class Page:
    """Everything on a page.

    tone, verdict, lead : whether it stands and prints, in a few words and in one sentence.
    cards : the figures to see first;  origin : how the page was made.
    view : what the viewer is told, as plain values;  geometry : its meshes as base64.
    still : a PNG as base64, for readers without a script.
    """

    name: str
    kicker: str
    tone: Tone
    verdict: str
    lead: str
    cards: tuple[Fact, ...]
    groups: tuple[Group, ...]
    findings: tuple[FindingRow, ...]
    poses: tuple[PoseRow, ...]
    curve: Curve | None
    origin: Group
    geometry: str
    still: str
    view: Mapping[str, Any] = field(default_factory=dict)
    form: Form | None = None


@dataclass(frozen=True)
class Source:
    """Where a page comes from.

    file : name of the file that was read;  sha256 : of its content.
    command : the command line, with file names but without folders; None where there was none.
    """

    file: str
    sha256: str
    command: str | None = None
