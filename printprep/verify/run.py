"""Slice a part with a real slicer, and compare the print with what was computed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.files import scratch_folder
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
    """A part, its print, and their differences.

    slicer : its name and version.
    printed : the print;  tilt_deg : its tilt angle, toward the lean's azimuth if it has one.
    mass_off : relative difference of the masses;  centre_off_mm : distance of the centres of mass;
    contact_off_mm : distance of the support polygons, None if the part has no contact.
    supported : the print with supports switched on, None for a part without cavities.
    baselines : the model with usual infills;  warnings : those of the slicer.
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
    """Slice a 3MF that printprep wrote, and compare the G-code with the figures in the 3MF.

    Parameters
    ----------
    slicer : the program; None looks for it.
    load : .ini or G-code whose settings are used instead of those of the part's profile.
    compare_with : the model that the part was made from; it is sliced with usual infills
        (:func:`printprep.verify.baselines.slice_baselines`).

    Raises
    ------
    InputError : printprep did not write the 3MF;  UsageError : its profile is not for filament;
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
        computed = computed_part(part)
        model = None if compare_with is None else model_of(computed, compare_with)
    settings = settings_for(computed, load)
    program = find_slicer(slicer)
    findings: list[Finding] = []
    with scratch_folder() as folder:
        with progress.stage("slice"):
            printed, warnings = slice_and_measure(program, computed, settings, load, folder)
        findings += compare(computed, printed)
        supported = None
        if computed.cavities:
            with progress.stage("slice-supports"):
                supported, _ = slice_and_measure(
                    program, computed, {**settings, **_SUPPORTS}, load, folder
                )
            findings += support_inside(supported)
        baselines: tuple[Baseline, ...] = ()
        if model is not None:
            with progress.stage("slice-baselines"):
                baselines = slice_baselines(program, computed, model, settings, load, folder)
    return Verified(
        part=computed,
        slicer=program.name,
        printed=printed,
        tilt_deg=tilt_as_printed(printed, computed.lean),
        mass_off=printed.mass_g / computed.mass_g - 1,
        centre_off_mm=centre_offset_mm(computed, printed),
        contact_off_mm=contact_offset_mm(computed, printed),
        supported=supported,
        baselines=baselines,
        warnings=warnings,
        findings=sorted_findings(findings),
    )


def settings_for(part: ComputedPart, load: Path | None) -> dict[str, str]:
    """The settings to slice a part with: the profile's, or only those that ``load`` lacks.

    Raises InputError if ``load`` cannot be read, UsageError for a profile that is not for filament.
    """
    from printprep.slicer.prusa_ini import profile_settings
    from printprep.slicer.sanitize import sets_density

    own = profile_settings(part.profile)
    if load is None:
        return own
    # PrusaSlicer's default is a density of 0: everything would weigh nothing.
    return {} if sets_density(load) else {"filament_density": own["filament_density"]}


def slice_and_measure(
    program: Slicer,
    part: ComputedPart,
    settings: Mapping[str, str],
    load: Path | None,
    folder: Path,
) -> tuple[Printed, tuple[str, ...]]:
    """The print of a part, and the slicer's warnings."""
    from printprep.gcode.measure import measure_sliced
    from printprep.verify.for_prusa import file_for_prusa

    gcode = folder / "part.gcode"
    sliced = program.slice(file_for_prusa(part, folder), gcode, settings, load)
    printed = measure_sliced(gcode, program.name, cavities=part.cavities, bodies=part.bodies)
    return printed, sliced.warnings
