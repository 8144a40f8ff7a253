"""The figures of a part, as its file carries them and as ``verify`` and the hook read them.

``figures.to_json()`` is written into the 3MF; ``Figures.from_json`` reads it and refuses an unknown
version.  Nothing in it depends on time, path, user or machine, so that the same input gives the
same bytes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from pydantic import Field, TypeAdapter, ValidationError

from printprep.output.numbers import plain
from printprep.types import (
    Advice,
    AlternativeFill,
    Certificate,
    Drain,
    Finding,
    Repair,
    VaultRule,
)

FORMAT = 1
"""Version of the keys.  It grows when a key changes its meaning; a reader refuses another one."""

Place = tuple[float, float, float]
Row = tuple[float, float, float, float]


@dataclass(frozen=True)
class ContactFigures:
    """The first layer's section: corners (x, y) of its hull, counter-clockwise, and its area."""

    polygon_mm: tuple[tuple[float, float], ...]
    area_mm2: float


@dataclass(frozen=True)
class Cavity:
    """One sealed or drained cavity.  bounds_mm : low and high corner."""

    volume_mm3: float
    bounds_mm: tuple[Place, Place]


@dataclass(frozen=True)
class Cavities:
    """All cavities, in the order of the part."""

    count: int
    items: tuple[Cavity, ...]


@dataclass(frozen=True)
class Vaults:
    """The vaults that carry the ceilings, in the whole hollowable volume.

    rule : whose overhang rule they keep, the printer's or the slicer's.
    """

    capitals: int
    columns: int
    added_mm3: float
    added_g: float
    unsupported_mm2: float
    islands: int
    rule: VaultRule = "slicer"  # what files without this key were built for


@dataclass(frozen=True)
class Drains:
    """Drain holes, the filled volume of floors, and the volumes of cavities that no hole drains."""

    count: int
    items: tuple[Drain, ...]
    filled_mm3: float
    closed_mm3: tuple[float, ...]


@dataclass(frozen=True)
class SparseInfill:
    """The slicer's infill.  weighed_with : the slicer whose G-code was weighed, None: estimated."""

    pattern: str
    density: float
    perimeters: int
    solid_layers: int
    ballast_g: float
    weighed_with: str | None
    slices: int


@dataclass(frozen=True)
class BaseFigures:
    """Height of the seat, growth of the footprint, and the mass that the base adds."""

    seat_mm: float
    growth_mm: float
    mass_g: float


@dataclass(frozen=True)
class Figures:
    """The computed figures of a part; lengths in mm, masses in g, angles in degrees.

    printprep : version;  settings : the profile's keys.
    placement : (4, 4) rows, model's file → part.
    mass_ratio : mass over that of the solid;  bounds_mm : low and high corner.
    contact, tilt_deg : None without contact;  bodies : number of bodies that do not touch.
    """

    printprep: str
    model: str
    profile: str
    settings: dict[str, Any]
    placement: tuple[Row, Row, Row, Row]
    solid_mass_g: float
    mass_g: float
    mass_ratio: float
    bounds_mm: tuple[Place, Place]
    centre_of_mass_mm: Place
    contact: ContactFigures | None
    bodies: int
    tilt_solid_deg: float | None
    tilt_deg: float | None
    lean_deg: float
    lean_azimuth_deg: float | None
    aim_deg: float | None
    reachable_deg: float | None
    advice: Advice | None
    supports: Vaults | None
    drains: Drains | None
    infill: SparseInfill | None
    alternative_fill: AlternativeFill | None
    wall_min_mm: float | None
    cavities: Cavities
    base: BaseFigures | None
    certificate: Certificate | None
    findings: tuple[Finding, ...]
    repair: Repair
    format: Annotated[int, Field(ge=FORMAT, le=FORMAT)] = FORMAT

    def to_json(self) -> dict[str, Any]:
        """The figures as plain values, the version of the keys first."""
        values = plain(self)
        return {"format": values.pop("format"), **values}

    @classmethod
    def from_json(cls, text: bytes | str) -> Figures:
        """Read what ``to_json`` wrote.

        Raises ValueError, in one line, for text that is not JSON, lacks a key, has another version,
        or holds a number that is not finite.
        """
        try:
            data = json.loads(text, parse_constant=_finite, parse_float=_finite)
        except (ValueError, RecursionError) as error:
            raise ValueError(f"it is not JSON ({error})") from error
        if not isinstance(data, Mapping) or data.get("format") != FORMAT:
            raise ValueError(f'it does not carry "format": {FORMAT}')
        try:
            figures: Figures = _READER.validate_python(data)
            return figures
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            key = ".".join(str(part) for part in first["loc"])
            raise ValueError(f"{key}: {first['msg']}") from error


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError(f"{text[:20]} is not a finite number")
    return value


_READER = TypeAdapter(Figures)
