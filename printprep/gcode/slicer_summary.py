"""Reads the slicer's own summary of a print (filament, time, settings) from its comments."""

from __future__ import annotations

import re

from printprep.gcode.modal_state import StateTracker, numbers
from printprep.gcode.printed import SlicerSummary

_TIME_CHARACTERS = 64
_SPAN = {"d": 86400, "h": 3600, "m": 60, "s": 1}
_TIME_KEYS = (
    "estimated printing time (normal mode)",  # PrusaSlicer, SuperSlicer, OrcaSlicer
    "total estimated time",  # BambuStudio
    "estimated printing time",
)


def summary_of(tracker: StateTracker) -> SlicerSummary:
    """The summary, after the last line of the file."""
    settings = tracker.settings
    cm3 = numbers(settings, "filament used [cm3]")
    grams = numbers(settings, "filament used [g]")
    return SlicerSummary(
        producer=tracker.producer,
        filament_mm3=1000 * sum(cm3) if cm3 else None,
        filament_g=sum(grams) if grams and sum(grams) else None,
        seconds=_seconds(settings),
        settings=dict(settings),
    )


def _seconds(settings: dict[str, str]) -> float | None:
    for key in _TIME_KEYS:
        spans = re.findall(r"(\d+(?:\.\d+)?)\s*([dhms])", settings.get(key, "")[:_TIME_CHARACTERS])
        if spans:
            return sum(float(number) * _SPAN[unit] for number, unit in spans)
    cura = re.fullmatch(r"\d+(?:\.\d+)?", settings.get("TIME", "")[:_TIME_CHARACTERS])
    return float(cura[0]) if cura else None
