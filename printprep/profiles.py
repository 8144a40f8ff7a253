"""What a printer can make: frozen profiles, read from TOML by name or by path, checked on the way.

A profile is named after its file.  Lengths are mm, densities g/cm³, angles degrees; overhang_deg is
measured from the vertical.  Every figure of the profiles that come with printprep has its source in
a comment beside it (:func:`profile_source`).

This module imports pydantic: import it inside the function that needs it, not at start-up.
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, ValidationError, model_validator
from pydantic_core import PydanticCustomError

from printprep.errors import UsageError

DEFAULT_PROFILE = "fdm-pla-0.4"

_FOLDERS = (
    Path(__file__).resolve().parent / "_profiles",  # inside an installed wheel
    Path(__file__).resolve().parent.parent / "profiles",  # in a checkout
)


def _bounded(low: float, high: float, **more: Any) -> Any:
    return Field(ge=low, le=high, allow_inf_nan=False, strict=True, **more)


def _setting_text(value: object) -> object:
    """TOML numbers and booleans as a slicer writes them; anything else is left to pydantic."""
    if isinstance(value, bool):
        return str(int(value))
    return f"{value:g}" if isinstance(value, int | float) else value


def _settings(value: object) -> object:
    if not isinstance(value, Mapping):
        return value
    if "post_process" in value:  # a file that carries commands must never leave this program
        raise PydanticCustomError("forbidden", "must not hold post_process, which runs commands")
    return {key: _setting_text(item) for key, item in value.items()}


class _Frozen(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True, validate_default=True)


class Printer(_Frozen):
    """The machine; nozzle and line width only where there is a nozzle."""

    nozzle_mm: float | None = _bounded(0.1, 2.0, default=None)
    line_width_mm: float | None = _bounded(0.1, 4.0, default=None)
    layer_height_mm: float = _bounded(0.005, 2.0)
    first_layer_mm: float = _bounded(0.005, 2.0)
    bed_mm: tuple[
        Annotated[float, _bounded(10, 5000)],
        Annotated[float, _bounded(10, 5000)],
        Annotated[float, _bounded(10, 5000)],
    ]


class Material(_Frozen):
    """What the part is made of, as printed."""

    name: str = Field(min_length=1, max_length=80, strict=True)
    density_g_cm3: float = _bounded(0.1, 25.0)


class Drain(_Frozen):
    """Holes per sealed cavity; count 0 where the process leaves nothing inside to drain."""

    diameter_mm: float | None = _bounded(0.3, 50.0, default=None)
    count: int = Field(default=0, ge=0, le=16, strict=True)


class Stability(_Frozen):
    """The lean a part must stand, solved for with a margin, and how far a base may go."""

    lean_deg: float = _bounded(0.0, 60.0)
    lean_margin_deg: float = _bounded(0.0, 10.0)
    base_seat_mm: float = _bounded(0.0, 20.0)
    base_growth_max_mm: float = _bounded(0.0, 50.0)


class SlicerSettings(_Frozen):
    """Keys every object of the 3MF carries, and the slicer that checks it (None: no check)."""

    object_settings: Annotated[dict[str, str], BeforeValidator(_settings)] = {}
    check_with: Literal["prusa-slicer"] | None = None


class Profile(_Frozen):
    """One printer, material and process, with the limits that a part has to keep."""

    name: str = Field(min_length=1, strict=True)
    process: Literal["fdm", "resin", "powder"]
    wall_mm: float = _bounded(0.2, 50.0)
    min_feature_mm: float = _bounded(0.1, 50.0)
    overhang_deg: float = _bounded(0.0, 90.0)
    printer: Printer
    material: Material
    drain: Drain = Drain()
    stability: Stability
    slicer: SlicerSettings = SlicerSettings()

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        printer, drain = self.printer, self.drain
        if self.process == "fdm":
            for key in ("nozzle_mm", "line_width_mm"):
                if getattr(printer, key) is None:
                    raise _impossible(f"printer.{key}", "is needed where process is fdm")
            assert printer.nozzle_mm is not None and printer.line_width_mm is not None
            _within("printer.layer_height_mm", printer.layer_height_mm, 0.0, printer.nozzle_mm)
            _within("printer.first_layer_mm", printer.first_layer_mm, 0.0, printer.nozzle_mm)
            low = 0.5 * printer.nozzle_mm
            _within("printer.line_width_mm", printer.line_width_mm, low, 3 * printer.nozzle_mm)
            _within("wall_mm", self.wall_mm, printer.line_width_mm, 50.0)
            _within("min_feature_mm", self.min_feature_mm, printer.line_width_mm, 50.0)
        else:
            for key in ("nozzle_mm", "line_width_mm"):
                if getattr(printer, key) is not None:
                    raise _impossible(f"printer.{key}", f"has no meaning for {self.process}")
            if self.slicer.check_with is not None:
                raise _impossible("slicer.check_with", f"has no slicer for {self.process}")
        if drain.count and drain.diameter_mm is None:
            raise _impossible("drain.diameter_mm", "is needed where drain.count is above 0")
        return self


def _impossible(key: str, fact: str) -> PydanticCustomError:
    return PydanticCustomError("impossible", "{fact}", {"key": key, "fact": fact})


def _within(key: str, value_mm: float, low_mm: float, high_mm: float) -> None:
    if not low_mm <= value_mm <= high_mm:
        raise _impossible(key, f"is {value_mm:g}, must be between {low_mm:g} and {high_mm:g}")


def profile_names() -> tuple[str, ...]:
    """Names of the profiles that come with printprep, sorted, the default first."""
    names = sorted(path.stem for path in _folder().glob("*.toml"))
    return tuple(sorted(names, key=lambda name: name != DEFAULT_PROFILE))


def profile_source(name: str | Path) -> str:
    """TOML text of a profile, comments and sources included; `name` as for load_profile."""
    path = _find(name)
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise UsageError(f"{name}: the profile cannot be read ({error})") from error


def load_profile(
    name_or_path: str | Path | Profile = DEFAULT_PROFILE,
    overrides: Mapping[str, object] = {},
) -> Profile:
    """The profile of that name, at that path, or given; with single keys overridden.

    overrides : dotted key → value, as {"stability.lean_deg": 12}.  A string is read as a TOML value
    where it is one ("12", "true"), and is taken as it stands where it is not ("100%").

    Raises UsageError that names file, key and the allowed range.
    """
    if isinstance(name_or_path, Profile):
        source, data = f"profile {name_or_path.name}", name_or_path.model_dump()
    else:
        path = _find(name_or_path)
        source = str(name_or_path) if path.parent != _folder() else f"profile {path.stem}"
        try:
            data = tomllib.loads(profile_source(name_or_path))
        except tomllib.TOMLDecodeError as error:
            raise UsageError(f"{source}: not valid TOML: {error}") from error
        if "name" in data:
            raise UsageError(f"{source}: name is not a key; a profile is named after its file")
        data["name"] = path.stem
    for key, value in overrides.items():
        _override(data, key, value)
    try:
        return Profile.model_validate(data)
    except ValidationError as error:
        raise _explain(error, source, overrides) from error


def _folder() -> Path:
    for folder in _FOLDERS:
        if folder.is_dir():
            return folder
    raise UsageError("the profiles that come with printprep are missing", "install it again")


def _find(name: str | Path) -> Path:
    known = profile_names()
    if isinstance(name, str) and name in known:
        return _folder() / f"{name}.toml"
    path = Path(name)
    if path.is_file():
        return path
    if path.suffix == ".toml" or len(path.parts) > 1:
        raise UsageError(f"{name}: there is no such profile file")
    close = difflib.get_close_matches(str(name), known, n=1)
    hint = f"did you mean {close[0]}?" if close else f"there are: {', '.join(known)}"
    raise UsageError(f"{name}: there is no profile of that name", hint)


def _override(data: dict[str, Any], key: str, value: object) -> None:
    *tables, last = key.split(".")
    for table in tables:
        data = data.setdefault(table, {})
        if not isinstance(data, dict):
            raise UsageError(f"{key}: {table} is not a table of a profile")
    data[last] = _toml_value(value) if isinstance(value, str) else value


def _toml_value(text: str) -> object:
    try:
        parsed = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return parsed["value"] if len(parsed) == 1 else text


def _explain(error: ValidationError, source: str, overrides: Mapping[str, object]) -> UsageError:
    problems = []
    for item in error.errors(include_url=False):
        key = item.get("ctx", {}).get("key") or ".".join(str(part) for part in item["loc"])
        where = "as overridden, " if key in overrides else ""
        problems.append(f"{where}{key} {_fact(item['type'], item['loc'], item)}")
    return UsageError(f"{source}: {'; '.join(problems)}", "printprep profiles show NAME lists them")


def _fact(kind: str, loc: tuple[int | str, ...], item: Mapping[str, Any]) -> str:
    if kind in ("impossible", "forbidden"):
        return str(item["msg"])
    model = _model_at(loc[:-1])
    keys = () if model is None else tuple(model.model_fields)
    if kind == "extra_forbidden":
        return f"is unknown; allowed here: {', '.join(key for key in keys if key != 'name')}"
    if kind == "missing":
        return f"is missing; {_range(loc)}".rstrip("; ")
    return f"is {item['input']!r}, {_range(loc) or item['msg']}"


def _model_at(loc: tuple[int | str, ...]) -> type[BaseModel] | None:
    model: type[BaseModel] | None = Profile
    for part in loc:
        field = model.model_fields.get(str(part)) if model else None
        inner = field.annotation if field else None
        model = inner if isinstance(inner, type) and issubclass(inner, BaseModel) else None
    return model


def _range(loc: tuple[int | str, ...]) -> str:
    """The allowed values at `loc` in words, from the field's own constraints."""
    named = tuple(part for part in loc if isinstance(part, str))
    model = _model_at(named[:-1])
    field = model.model_fields.get(named[-1]) if model and named else None
    if field is None:
        return ""
    bounds = {
        kind: getattr(mark, kind)
        for mark in field.metadata
        for kind in ("ge", "le")
        if hasattr(mark, kind)
    }
    if named[-1] == "bed_mm":
        return "must be [x, y, z], three numbers between 10 and 5000"
    if bounds:
        return f"must be a number between {bounds['ge']:g} and {bounds['le']:g}"
    return ""
