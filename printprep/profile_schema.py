"""The keys of a profile, their allowed ranges, and which of them exclude each other."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    model_validator,
)
from pydantic_core import PydanticCustomError

from printprep.process import PROCESSES, Process


def _bounded(low: float, high: float, **more: Any) -> Any:
    return Field(ge=low, le=high, allow_inf_nan=False, strict=True, **more)


def _setting_text(value: object) -> object:
    """TOML numbers and booleans as a slicer writes them; pydantic judges all other values."""
    if isinstance(value, bool):
        return str(int(value))
    return f"{value:g}" if isinstance(value, int | float) else value


def _settings(value: object) -> object:
    if not isinstance(value, Mapping):
        return value
    if "post_process" in value:  # printprep never writes a file that carries commands
        raise PydanticCustomError("forbidden", "must not hold post_process, which runs commands")
    return {key: _setting_text(item) for key, item in value.items()}


def _known_process(value: str) -> str:
    if value not in PROCESSES:
        *others, last = PROCESSES
        known = f"{', '.join(others)} or {last}"
        raise PydanticCustomError("unknown", "must be {known}", {"known": known})
    return value


class _Frozen(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=True)


# A third of a line rests on the line below.
OVERHANG_SHARE = 0.667

_BedSide = Annotated[float, _bounded(10, 5000)]


class Printer(_Frozen):
    """The machine; nozzle_mm, line_width_mm and filament_mm only for fdm.

    filament_mm : diameter of the filament, for its length; None: 1.75.
    """

    nozzle_mm: float | None = _bounded(0.1, 2.0, default=None)
    line_width_mm: float | None = _bounded(0.1, 4.0, default=None)
    filament_mm: float | None = _bounded(0.5, 5.0, default=None)
    layer_height_mm: float = _bounded(0.005, 2.0)
    first_layer_mm: float = _bounded(0.005, 2.0)
    bed_mm: tuple[_BedSide, _BedSide, _BedSide] = Field(
        description="must be [x, y, z], three numbers between 10 and 5000"
    )


class Material(_Frozen):
    """The material of the part, as printed.

    price_per_kg : what a kilogram costs, in ``currency``, which is repeated as it is.
    """

    name: str = Field(min_length=1, max_length=80, strict=True)
    density_g_cm3: float = _bounded(0.1, 25.0)
    price_per_kg: float | None = _bounded(0.0, 1e6, default=None)
    currency: str | None = Field(default=None, min_length=1, max_length=12, strict=True)


class OverhangSettings(_Frozen):
    """What the printer lays without support where nobody sees it: inside cavities.

    share : how far a line may stand out over the one below, as a share of its width.
    """

    share: float = _bounded(0.1, 0.9, default=OVERHANG_SHARE)


class DrainSettings(_Frozen):
    """Drain holes of each sealed cavity; count 0 where the process leaves nothing to drain.

    count : fewest holes of each cavity;  cm3_per_hole : at least one hole for this much volume, for
        a filling that does not flow by itself (powder).
    """

    diameter_mm: float | None = _bounded(0.3, 50.0, default=None)
    count: int = Field(default=0, ge=0, le=16, strict=True)
    cm3_per_hole: float | None = _bounded(1.0, 1e6, default=None)

    def holes_of(self, volume_mm3: float) -> int:
        """Fewest holes of a cavity with this volume."""
        if not self.cm3_per_hole:
            return self.count
        return max(self.count, math.ceil(volume_mm3 / 1000 / self.cm3_per_hole))


class StabilitySettings(_Frozen):
    """The lean that a part must stand, the margin added to it, and how far a base may grow."""

    lean_deg: float = _bounded(0.0, 60.0)
    lean_margin_deg: float = _bounded(0.0, 10.0)
    base_seat_mm: float = _bounded(0.0, 20.0)
    base_growth_max_mm: float = _bounded(0.0, 50.0)


class SlicerSettings(_Frozen):
    """Slicer keys of every object in the 3MF, and the slicer that checks it (None: no check)."""

    object_settings: Annotated[dict[str, str], BeforeValidator(_settings)] = {}
    check_with: Literal["prusa-slicer"] | None = None


class InfillSettings(_Frozen):
    """The slicer's sparse infill, which takes the place of cavities (--fill infill).

    perimeters : lines in the wall; None for as many as fit into wall_mm.
    """

    pattern: Literal["lightning", "gyroid"]
    density: float = _bounded(0.01, 0.9)
    perimeters: int | None = Field(default=None, ge=1, le=50, strict=True)


class Profile(_Frozen):
    """One printer, material and process, with the limits that a part must keep."""

    name: str = Field(min_length=1, strict=True)
    process: Annotated[str, AfterValidator(_known_process)]
    wall_mm: float = _bounded(0.2, 50.0)
    min_feature_mm: float = _bounded(0.1, 50.0)
    min_gap_mm: float | None = _bounded(0.01, 50.0, default=None)
    overhang_deg: float = _bounded(0.0, 90.0)
    column_slenderness: float | None = _bounded(2.0, 100.0, default=None)
    overhang: OverhangSettings | None = None
    printer: Printer
    material: Material
    drain: DrainSettings = DrainSettings()
    stability: StabilitySettings
    slicer: SlicerSettings = SlicerSettings()
    infill: InfillSettings | None = None

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        printer, drain = self.printer, self.drain
        needed = f"is needed where process is {self.process}"
        if self.traits.has_nozzle:
            for key in ("nozzle_mm", "line_width_mm"):
                if getattr(printer, key) is None:
                    raise _impossible(f"printer.{key}", needed)
            if self.column_slenderness is None:
                raise _impossible("column_slenderness", needed)
            assert printer.nozzle_mm is not None and printer.line_width_mm is not None
            _within("printer.layer_height_mm", printer.layer_height_mm, 0.0, printer.nozzle_mm)
            _within("printer.first_layer_mm", printer.first_layer_mm, 0.0, printer.nozzle_mm)
            low = 0.5 * printer.nozzle_mm
            _within("printer.line_width_mm", printer.line_width_mm, low, 3 * printer.nozzle_mm)
            _within("wall_mm", self.wall_mm, printer.line_width_mm, 50.0)
            _within("min_feature_mm", self.min_feature_mm, printer.line_width_mm, 50.0)
        else:
            for key in ("nozzle_mm", "line_width_mm", "filament_mm"):
                if getattr(printer, key) is not None:
                    raise _impossible(f"printer.{key}", f"has no meaning for {self.process}")
            if self.slicer.check_with is not None:
                raise _impossible("slicer.check_with", f"has no slicer for {self.process}")
            for key in ("infill", "column_slenderness", "overhang"):
                if getattr(self, key) is not None:
                    raise _impossible(key, f"has no meaning for {self.process}")
        if drain.count and drain.diameter_mm is None:
            raise _impossible("drain.diameter_mm", "is needed where drain.count is above 0")
        return self

    @property
    def traits(self) -> Process:
        """What the profile's process does to a part."""
        return PROCESSES[self.process]

    @property
    def crumb_mm3(self) -> float:
        """Volume below which a body or a void is a crumb that no printer makes.

        It is the least feature in one layer: a dot of min_feature_mm.
        """
        return self.min_feature_mm**2 * self.printer.layer_height_mm

    @property
    def overhang_share(self) -> float:
        """How far a line may stand out over the one below in a cavity, as a share of its width."""
        return OVERHANG_SHARE if self.overhang is None else self.overhang.share

    @property
    def object_settings(self) -> Mapping[str, str]:
        """Slicer keys of every object in the 3MF: the profile's, and walls made of perimeters only.

        Where the perimeters of both faces leave a gap, the slicer fills it with infill that
        overlaps them by a quarter of a line: a wall of 2.0 to 2.4 mm prints 5 % too heavy.  Two
        perimeters, the default of slicers, close a wall four lines thick.
        """
        keys = dict(self.slicer.object_settings)
        width_mm = self.printer.line_width_mm
        if width_mm is not None:
            perimeters = math.ceil(self.wall_mm / (2 * width_mm) - 1e-6)
            if perimeters > 2:
                keys.setdefault("perimeters", str(perimeters))
        return keys


def _impossible(key: str, fact: str) -> PydanticCustomError:
    return PydanticCustomError("impossible", "{fact}", {"key": key, "fact": fact})


def _within(key: str, value_mm: float, low_mm: float, high_mm: float) -> None:
    if not low_mm <= value_mm <= high_mm:
        raise _impossible(key, f"is {value_mm:g}, must be between {low_mm:g} and {high_mm:g}")
