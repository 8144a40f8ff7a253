"""The settings to enter by hand in a slicer that takes only the shape from a file.

Their names are the English ones of OrcaSlicer 2 and BambuStudio, and of Cura 4.13.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, get_args

from printprep.errors import UsageError
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
        },
        ("nothing that shrinks the first layer", "nothing that closes holes"),
    ),
}


def check_slicer(profile: Profile, slicer: SlicerName) -> None:
    """Raise UsageError if the profile's process does not go with a filament slicer."""
    if slicer != "prusa" and not profile.traits.has_nozzle:
        raise UsageError(
            f"--for {slicer} needs a filament profile; {profile.name} is for {profile.process}.",
            "Leave out --for, or choose a profile for filament.",
        )


def manual_settings(profile: Profile, slicer: SlicerName) -> tuple[str, list[str]]:
    """The name of a slicer other than PrusaSlicer, and the settings to enter in it."""
    vocabulary = _VOCABULARIES[slicer]
    return vocabulary.program, list(_settings(profile, vocabulary))


def _settings(profile: Profile, vocabulary: _Vocabulary) -> Iterator[str]:
    printer = profile.printer
    yield f"{vocabulary.layer} {printer.layer_height_mm:g} mm"
    yield f"{vocabulary.first_layer} {printer.first_layer_mm:g} mm"
    if printer.line_width_mm is not None:
        yield f"{vocabulary.width} {printer.line_width_mm:g} mm"
    for key, value in profile.object_settings.items():
        known, translation = vocabulary.keys.get(key, (None, None))
        if known not in ("", value):
            yield f"{key}={value} (PrusaSlicer's name)"
        elif translation is not None:
            yield translation.format(value)
    yield from vocabulary.always
