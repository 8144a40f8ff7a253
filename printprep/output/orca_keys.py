"""PrusaSlicer's keys of an object in the words of OrcaSlicer and BambuStudio.

Both keep settings of an object and of a part of it; of each key used here they know the same name,
and of each value too: the lines that touch at full density are "monotonic" in both, while
rectilinear lines are "rectilinear" in one and "zig-zag" in the other.

Source: src/libslic3r/PrintConfig.cpp (s_keys_map_InfillPattern, s_keys_map_SlicingMode) and
PrintConfig.hpp (PrintObjectConfig, PrintRegionConfig) of both programs.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from printprep.threemf.item import Item

_KEYS: Mapping[str, str] = {
    "perimeters": "wall_loops",
    "top_solid_layers": "top_shell_layers",
    "bottom_solid_layers": "bottom_shell_layers",
    "fill_density": "sparse_infill_density",
    "fill_pattern": "sparse_infill_pattern",
    "support_material_buildplate_only": "support_on_build_plate_only",
    "elefant_foot_compensation": "elefant_foot_compensation",
    "slicing_mode": "slicing_mode",
}
# PrusaSlicer's names of patterns that both programs know; any other stays to be set by hand.
_PATTERNS: Mapping[str, str] = {
    "rectilinear": "monotonic",
    "monotonic": "monotonic",
    "monotoniclines": "monotonicline",
    "stars": "tri-hexagon",
    **{
        name: name
        for name in (
            *("alignedrectilinear", "line", "grid", "triangles", "cubic", "adaptivecubic"),
            *("supportcubic", "honeycomb", "3dhoneycomb", "gyroid", "lightning", "concentric"),
            *("hilbertcurve", "archimedeanchords", "octagramspiral"),
        )
    },
}
# Nothing shrinks the first layer or closes the cavities.
ALWAYS: Mapping[str, str] = {"elefant_foot_compensation": "0", "slicing_mode": "regular"}


def orca_setting(key: str, value: str) -> tuple[str, str] | None:
    """A setting of PrusaSlicer as key and value, None where these slicers have none."""
    known = _KEYS.get(key)
    if known == "sparse_infill_pattern":
        pattern = _PATTERNS.get(value)
        return None if pattern is None else (known, pattern)
    return None if known is None else (known, value)


def orca_settings(settings: Mapping[str, str]) -> dict[str, str]:
    """The settings that these slicers read from the file."""
    pairs = (orca_setting(key, value) for key, value in settings.items())
    return dict(pair for pair in pairs if pair is not None)


def object_settings(settings: Mapping[str, str]) -> dict[str, str]:
    """All settings of an object that the file carries."""
    return {**ALWAYS, **orca_settings(settings)}


def orca_item(item: Item) -> Item:
    """An item with settings for PrusaSlicer as one with settings for OrcaSlicer and BambuStudio."""
    volumes = [replace(one, settings=orca_settings(one.settings)) for one in item.volumes]
    return replace(item, volumes=volumes, settings=object_settings(item.settings))
