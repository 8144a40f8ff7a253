"""Slice a part with the real slicer, and compare what it prints with what was computed."""

from __future__ import annotations

import re
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import InputError
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.gcode.printed import Printed
    from printprep.slicer.process import Slicer
    from printprep.types import Finding
    from printprep.verify.baselines import Baseline
    from printprep.verify.part_3mf import ComputedPart

_SUPPORTS = {"support_material": "1", "support_material_auto": "1"}


@dataclass(frozen=True, eq=False)
class Verified:
    """A part, the print of it, and where they differ.

    slicer : its name and version;  tilt_deg : of the print, toward the lean's azimuth;
    mass_off : relative, centre_off_mm, contact_off_mm : how far the print is from the computed
    figures;  printed : with the settings given;  supported : with supports
    switched on too, None for a part without cavities;  others : what the model printed in other
    ways comes to;  warnings : the slicer's own.
    """

    part: ComputedPart
    slicer: str
    printed: Printed
    tilt_deg: float
    mass_off: float
    centre_off_mm: float
    contact_off_mm: float | None
    supported: Printed | None
    baselines: tuple[Baseline, ...]
    warnings: tuple[str, ...]
    findings: tuple[Finding, ...]


def verify(
    part: str | Path,
    *,
    slicer: Path | None = None,
    load: Path | None = None,
    compare_with: Path | None = None,
    progress: Progress = SILENT,
) -> Verified:
    """Slice a 3MF of ours and compare the G-code with the figures the 3MF carries.

    Parameters
    ----------
    slicer : the program; None looks for it.
    load : .ini or G-code whose settings are used instead of those of the part's profile.
    compare_with : the model the part was made of, sliced in the same run as it would be printed
        otherwise (:func:`printprep.verify.baselines.slice_baselines`).

    Raises
    ------
    InputError : the 3MF is not ours;  UsageError : its profile is not for filament;
    ToolError : there is no slicer, or it failed.
    """
    from printprep.check.registry import sorted_findings
    from printprep.gcode.stability import tilt_as_printed
    from printprep.slicer.process import find_slicer
    from printprep.verify.baselines import model_of, slice_baselines
    from printprep.verify.part_3mf import computed_part
    from printprep.verify.rules import (
        centre_offset_mm,
        compare,
        contact_offset_mm,
        support_inside,
    )

    with progress.stage("read-part"):
        carried = computed_part(part)
        model = None if compare_with is None else model_of(carried, compare_with)
    settings = settings_for(carried, load)
    program = find_slicer(slicer)
    findings: list[Finding] = []
    with tempfile.TemporaryDirectory(prefix="printprep-") as name:
        folder = Path(name)
        with progress.stage("slice"):
            printed, warnings = slice_and_measure(program, carried, settings, load, folder)
        findings += compare(carried, printed)
        supported = None
        if carried.cavities:
            with progress.stage("slice-supports"):
                supported, _ = slice_and_measure(
                    program, carried, {**settings, **_SUPPORTS}, load, folder
                )
            findings += support_inside(supported)
        baselines: tuple[Baseline, ...] = ()
        if model is not None:
            with progress.stage("slice-baselines"):
                baselines = slice_baselines(program, carried, model, settings, load, folder)
    return Verified(
        part=carried,
        slicer=program.name,
        printed=printed,
        tilt_deg=tilt_as_printed(printed, carried.lean),
        mass_off=printed.mass_g / carried.mass_g - 1,
        centre_off_mm=centre_offset_mm(carried, printed),
        contact_off_mm=contact_offset_mm(carried, printed),
        supported=supported,
        baselines=baselines,
        warnings=warnings,
        findings=sorted_findings(findings),
    )


def settings_for(part: ComputedPart, load: Path | None) -> dict[str, str]:
    """What a part is sliced with: the profile's settings, or only what ``load`` leaves unsaid.

    Raises InputError where ``load`` cannot be read, UsageError for a profile that is not fdm.
    """
    from printprep.slicer.prusa_ini import profile_settings

    own = profile_settings(part.profile)
    if load is None:
        return own
    # PrusaSlicer's default is a density of 0: everything would weigh nothing
    return {} if _says_density(load) else {"filament_density": own["filament_density"]}


def slice_and_measure(
    program: Slicer,
    part: ComputedPart,
    settings: Mapping[str, str],
    load: Path | None,
    folder: Path,
) -> tuple[Printed, tuple[str, ...]]:
    """The print of a part, and what the slicer warned of."""
    from printprep.gcode.measure import measure_gcode

    gcode = folder / "part.gcode"
    sliced = program.slice(part.file, gcode, settings, load)
    return measure_gcode(gcode, cavities=part.cavities, bodies=part.bodies), sliced.warnings


def _says_density(config: Path) -> bool:
    try:
        with config.open("rb") as lines:
            return any(_density(line) for line in lines if b"filament_density" in line)
    except OSError as error:
        raise InputError(f"{config}: cannot be read ({error.strerror})") from error


def _density(line: bytes) -> bool:
    found = re.match(rb"[;\s]*filament_density\s*=\s*([\d.,\s]+)", line)
    if found is None:
        return False
    return any(float(value) > 0 for value in re.findall(rb"\d*\.?\d+", found[1]))
