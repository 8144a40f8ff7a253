"""Measures a G-code, judges it, and writes the figures into it.

The G-code is changed only at the end, in one step (:mod:`printprep.hook.gcode_file`).  While a hook
runs, the variable PRINTPREP_IN_HOOK is set.  A hook does nothing where it is set already, so that a
slicer that a hook starts does not start the hook again.
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.errors import InputError
from printprep.types import Finding
from printprep.version import __version__

if TYPE_CHECKING:
    from printprep.arrays import Float
    from printprep.gcode.printed import Printed
    from printprep.types import Lean
    from printprep.verify.part_3mf import ComputedPart

IN_HOOK = "PRINTPREP_IN_HOOK"
_SAME_SIZE_MM = 1.0


@dataclass(frozen=True, eq=False)
class JudgedPrint:
    """A G-code with its figures and findings.

    part : the part it was compared with, moved to the place of the print, or None.
    """

    printed: Printed
    lean: Lean
    part: ComputedPart | None
    findings: tuple[Finding, ...]


def already_running() -> bool:
    """Whether this hook was started by the slicer of another hook."""
    return IN_HOOK in os.environ


@contextmanager
def guarded() -> Iterator[None]:
    """Marks every program that is started meanwhile as started by a hook."""
    os.environ[IN_HOOK] = "1"
    try:
        yield
    finally:
        del os.environ[IN_HOOK]


def judge(gcode: Path, *, lean: Lean, part: Path | None = None) -> JudgedPrint:
    """Measure a G-code, and compare it with the figures of a part.

    lean : the lean at which it should stand; with a part, the part's lean counts.

    Raises InputError if the G-code or the part cannot be read.
    """
    from printprep.check.registry import sorted_findings
    from printprep.verify.part_3mf import computed_part
    from printprep.verify.rules import compare

    computed = None if part is None else computed_part(part)
    printed = measured(gcode)
    findings = [*_several_objects(printed), *_features_unknown(gcode, printed)]
    if computed is None:
        findings += tips(printed, lean)
    else:
        lean = computed.lean
        computed = moved_to(computed, printed)
        if same_size(computed.size_mm, printed):
            printed = measured(gcode, computed)
            findings += compare(computed, printed)
        else:
            findings += [_another_print(computed, printed), *tips(printed, lean)]
    return JudgedPrint(printed, lean, computed, sorted_findings(findings))


def judge_and_annotate(
    gcode: Path,
    *,
    profile: str,
    lean: str | None = None,
    part: Path | None = None,
    strict: bool = False,
) -> JudgedPrint:
    """Judge a G-code and write the figures at its end.

    profile, lean : the lean at which the print should stand; None takes the profile's.
    strict : leave the G-code unchanged if a finding is an error.

    Raises InputError if the G-code or the part cannot be read, UsageError for the profile or the
    lean, OutputError if the G-code cannot be rewritten.
    """
    from printprep.hook.gcode_file import annotate
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of

    requested = lean_of(lean, load_profile(profile).stability.lean_deg)
    judged = judge(gcode, lean=requested, part=part)
    if not (strict and any(item.severity == "error" for item in judged.findings)):
        annotate(gcode, notes(judged))
    return judged


def measured(gcode: Path, part: ComputedPart | None = None) -> Printed:
    """The figures of a G-code.

    What the G-code does not tell about the filament is read from the environment variables that the
    slicer sets.
    """
    from printprep.gcode.measure import measure_gcode

    cavities, bodies = ((), ()) if part is None else (part.cavities, part.bodies)
    printed = measure_gcode(gcode, cavities=cavities, bodies=bodies)
    settings = printed.slicer_summary.settings
    diameter = None if "filament_diameter" in settings else _setting("FILAMENT_DIAMETER")
    density = None if "filament_density" in settings else _setting("FILAMENT_DENSITY")
    if diameter is None and density is None:
        return printed
    return measure_gcode(
        gcode, cavities=cavities, bodies=bodies, diameter_mm=diameter, density_g_cm3=density
    )


def tips(printed: Printed, lean: Lean) -> Iterator[Finding]:
    """Whether a print tips over at less than the lean."""
    from printprep.verify.rules import printed_tilt

    yield from printed_tilt(
        printed,
        lean,
        promised_deg=lean.angle_deg,
        fix="Print it with a brim that stays on, or hollow the model with `printprep hollow`.",
    )


def notes(judged: JudgedPrint) -> list[str]:
    """The lines for the G-code, "key = value" each; they do not depend on machine or time."""
    from printprep.gcode.stability import tilt_as_printed

    printed = judged.printed
    tilt = tilt_as_printed(printed, judged.lean)
    azimuth = judged.lean.azimuth_deg
    lines = {
        "version": __version__,
        "mass_g": f"{printed.mass_g:.3f}",
        "centre_of_mass_mm": ", ".join(f"{value:.3f}" for value in printed.centre_of_mass_mm),
        "contact_area_mm2": f"{printed.contact_area_mm2:.1f}",
        "tilt_deg": f"{tilt:.2f}",
        "lean_deg": f"{judged.lean.angle_deg:g}" + ("" if azimuth is None else f"@{azimuth:g}"),
        "stands": _stands(printed, tilt, judged.lean),
        "left_out": ", ".join(printed.left_out) or "nothing",
    }
    if judged.part is not None:
        lines["computed_mass_g"] = f"{judged.part.mass_g:.3f}"
        lines["in_cavities_mm3"] = f"{printed.in_cavities_mm3:.2f}"
    lines["findings"] = ", ".join(item.rule for item in judged.findings) or "none"
    return [f"{key} = {value}" for key, value in lines.items()]


def _stands(printed: Printed, tilt_deg: float, lean: Lean) -> str:
    """Whether the print stands at the lean: yes, no, or unknown where its features are."""
    if not tilt_deg >= lean.angle_deg:  # a tilt angle that is no number never stands
        return "no"
    return "yes" if printed.labelled else "unknown"


def moved_to(part: ComputedPart, printed: Printed) -> ComputedPart:
    """The part, moved over the bed to the place of the print."""
    contact = part.contact_polygon_mm
    low, high = printed.bounds_mm
    shift = np.zeros(3)
    shift[:2] = ((low + high) / 2 - part.middle_mm)[:2]
    matrix = np.eye(4)
    matrix[:3, 3] = shift
    x, y, z = (float(value) for value in shift)
    return replace(
        part,
        centre_mm=part.centre_mm + shift,
        middle_mm=part.middle_mm + shift,
        contact_polygon_mm=contact + shift[:2],
        sure_polygon_mm=part.sure_polygon_mm + shift[:2],
        placement=matrix @ part.placement,
        cavities=tuple(cavity.translate((x, y, z)) for cavity in part.cavities),
        bodies=tuple(body.translate((x, y, z)) for body in part.bodies),
    )


def same_size(size_mm: Float, printed: Printed) -> bool:
    """Whether a print is as large as a model of this size, (3,) mm, to about two lines."""
    return bool((np.abs(np.ptp(printed.bounds_mm, axis=0) - size_mm) <= _SAME_SIZE_MM).all())


def _another_print(part: ComputedPart, printed: Printed) -> Finding:
    sizes = " × ".join(f"{side:.1f}" for side in np.ptp(printed.bounds_mm, axis=0))
    part_sizes = " × ".join(f"{side:.1f}" for side in part.size_mm)
    return finding(
        "another-print",
        f"The print measures {sizes} mm, but {part.file.name} measures {part_sizes} mm: they were "
        "not compared.",
        "Slice that file alone, neither turned nor scaled.",
    )


def _several_objects(printed: Printed) -> Iterator[Finding]:
    if len(printed.objects) > 1:
        yield finding(
            "several-objects",
            f"The G-code prints {len(printed.objects)} objects; mass and tilt angle are those of "
            "all together.",
            "Export the objects one by one to judge each.",
        )


def _features_unknown(gcode: Path, printed: Printed) -> Iterator[Finding]:
    if not printed.labelled:
        yield finding(
            "features-unknown",
            f"{gcode.name} does not label its features: skirt, brim and supports cannot be told "
            "from the model. Mass and tilt angle count all of them, so whether the print stands is "
            "unknown.",
            "Export it from a slicer that writes labels, with comments (PrusaSlicer, OrcaSlicer, "
            "BambuStudio, Cura, Simplify3D, ideaMaker, KISSlicer).",
        )


def _setting(key: str) -> float | None:
    """The first extruder's value of a print setting, from the slicer's environment variables."""
    value = os.environ.get(f"SLIC3R_{key}", "").split(",")[0]
    try:
        number = float(value)
    except ValueError:
        return None
    if not math.isfinite(number):
        raise InputError(f"The slicer's variable SLIC3R_{key} is {value}, which is no number.")
    return number if number > 0 else None
