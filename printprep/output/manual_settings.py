"""The settings to enter by hand in a slicer that does not take them from a file.

Their names are the English ones of OrcaSlicer 2 and BambuStudio, and of Cura 4.13.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, get_args

from printprep.errors import UsageError
from printprep.output.orca_keys import orca_setting
from printprep.types import SlicerName

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from printprep.profiles import Profile

SLICERS: tuple[SlicerName, ...] = get_args(SlicerName)


@dataclass(frozen=True)
class _Vocabulary:
    """The names that a slicer has for settings.

    layer, first_layer, width : for lengths.
    keys : PrusaSlicer's key → the value that is translated ("" for any value), and the translation
    (None if the slicer needs no such setting).
    always : settings that keep any print as it was computed.
    """

    program: str
    layer: str
    first_layer: str
    width: str
    keys: Mapping[str, tuple[str, str | None]]
    always: tuple[str, ...] = field(default=())


_VOCABULARIES: Mapping[str, _Vocabulary] = {
    "orca": _Vocabulary(
        "OrcaSlicer or BambuStudio",
        "Layer height",
        "First (initial) layer height",
        "Line width",
        {
            "fill_density": ("100%", "Sparse infill density 100 %"),
            "fill_pattern": ("rectilinear", "Sparse infill pattern Rectilinear"),
            "support_material_buildplate_only": ("1", "Support: On build plate only"),
            "perimeters": ("", "Wall loops {}"),
            "small_perimeter_speed": ("", None),  # its threshold is 0 by default
            "support_material_closing_radius": ("", None),
        },
        ("Elephant foot compensation 0 mm", "Slicing mode Regular"),
    ),
    "cura": _Vocabulary(
        "Cura",
        "Layer Height",
        "Initial Layer Height",
        "Line Width",
        {
            "fill_density": ("100%", "Infill Density 100 %"),
            "fill_pattern": ("rectilinear", None),  # at 100 % it is all skin
            "support_material_buildplate_only": ("1", "Support Placement: Touching Buildplate"),
            "perimeters": ("", "Wall Line Count {}"),
            "small_perimeter_speed": ("", None),  # small loops are not slowed down
        },
        ("Initial Layer Horizontal Expansion 0 mm", "Remove All Holes off"),
    ),
    "generic": _Vocabulary(
        "The slicer",
        "layer height",
        "first layer height",
        "line width",
        {
            "fill_density": ("100%", "infill 100 %"),
            "fill_pattern": ("rectilinear", "infill of straight lines"),
            "support_material_buildplate_only": ("1", "supports from the build plate only"),
            "perimeters": ("", "{} perimeters"),
            "small_perimeter_speed": ("", None),
        },
        ("nothing that shrinks the first layer", "nothing that closes holes"),
    ),
}


# The names that OrcaSlicer and BambuStudio show for the settings of an object.
_OBJECT_WORDS: Mapping[str, str] = {
    "wall_loops": "Wall loops {}",
    "top_shell_layers": "Top shell layers {}",
    "bottom_shell_layers": "Bottom shell layers {}",
    "sparse_infill_density": "Sparse infill density {}",
    "sparse_infill_pattern": "Sparse infill pattern {}",
    "support_on_build_plate_only": "Support on build plate only {}",
    "elefant_foot_compensation": "Elephant foot compensation {} mm",
    "slicing_mode": "Slicing mode {}",
}
_SWITCHES = ("support_on_build_plate_only",)
_ON_OFF: Mapping[str, str] = {"1": "on", "0": "off"}


def check_slicer(profile: Profile, slicer: SlicerName) -> None:
    """Raise UsageError if the profile's process does not go with a filament slicer."""
    if slicer != "prusa" and not profile.traits.has_nozzle:
        raise UsageError(
            f"--for {slicer} needs a filament profile; {profile.name} is for {profile.process}.",
            "Leave out --for, or choose a profile for filament.",
        )


def manual_settings(
    profile: Profile, slicer: SlicerName, *, carried: bool = False
) -> tuple[str, list[str]]:
    """The name of a slicer other than PrusaSlicer, and the settings to enter in it.

    carried : the file holds settings of the object that the slicer reads; they are left out.
    """
    vocabulary = _VOCABULARIES[slicer]
    return vocabulary.program, list(_settings(profile, vocabulary, carried))


def object_settings_in_words(settings: Mapping[str, str]) -> list[str]:
    """Settings of an object as OrcaSlicer and BambuStudio show them.

    settings : in the keys of these slicers, all known to ``output.orca_keys``.
    """
    return [
        _OBJECT_WORDS[key].format(_ON_OFF.get(value, value) if key in _SWITCHES else _shown(value))
        for key, value in settings.items()
    ]


def _shown(value: str) -> str:
    return value.replace("%", " %") if value[:1].isdigit() else value.capitalize()


def _settings(profile: Profile, vocabulary: _Vocabulary, carried: bool) -> Iterator[str]:
    printer = profile.printer
    yield f"{vocabulary.layer} {printer.layer_height_mm:g} mm"
    yield f"{vocabulary.first_layer} {printer.first_layer_mm:g} mm"
    if printer.line_width_mm is not None:
        yield f"{vocabulary.width} {printer.line_width_mm:g} mm"
    if not carried:
        yield from _in_words(profile.object_settings, vocabulary)
        yield from vocabulary.always
        return
    left = {
        key: value for key, value in profile.object_settings.items() if not orca_setting(key, value)
    }
    yield from _in_words(left, vocabulary)


def _in_words(settings: Mapping[str, str], vocabulary: _Vocabulary) -> Iterator[str]:
    for key, value in settings.items():
        known, translation = vocabulary.keys.get(key, (None, None))
        if known not in ("", value):
            yield f"{key}={value} (PrusaSlicer's name)"
        elif translation is not None:
            yield translation.format(value)
