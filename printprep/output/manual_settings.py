"""What a user has to set by hand in a slicer that takes only the shape from our file.

Setting names are the English ones of OrcaSlicer 2 and BambuStudio, and of Cura 4.13.
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
class _Words:
    """How a slicer calls things.

    layer, first_layer, width : its names of lengths;  keys : what stands for a PrusaSlicer setting
    of the object, and for which value of it ("" for every one);  always : what else keeps the
    print what was computed.
    """

    program: str
    layer: str
    first_layer: str
    width: str
    keys: Mapping[str, tuple[str, str | None]]
    always: tuple[str, ...] = field(default=())


_WORDS: Mapping[str, _Words] = {
    "orca": _Words(
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
    "cura": _Words(
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
    "generic": _Words(
        "The slicer",
        "layer height",
        "first layer's height",
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
    """Raises UsageError where there is no such slicer: the process is not fdm."""
    if slicer != "prusa" and not profile.traits.has_nozzle:
        raise UsageError(
            f"--for {slicer} needs a filament profile; {profile.name} is for {profile.process}.",
            "Leave --for out.",
        )


def manual_settings(profile: Profile, slicer: SlicerName) -> tuple[str, list[str]]:
    """What a slicer other than PrusaSlicer is called, and the settings it must be given."""
    words = _WORDS[slicer]
    return words.program, list(_settings(profile, words))


def _settings(profile: Profile, words: _Words) -> Iterator[str]:
    printer = profile.printer
    yield f"{words.layer} {printer.layer_height_mm:g} mm"
    yield f"{words.first_layer} {printer.first_layer_mm:g} mm"
    if printer.line_width_mm is not None:
        yield f"{words.width} {printer.line_width_mm:g} mm"
    for key, value in profile.object_settings.items():
        known, said = words.keys.get(key, (None, None))
        if known not in ("", value):
            yield f"{key}={value} (in PrusaSlicer's words)"
        elif said is not None:
            yield said.format(value)
    yield from words.always
