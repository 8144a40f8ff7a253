"""What a slicer's post-processing script does here: measure the G-code, judge it, write it down.

The G-code is changed only at the very end, in one step (:mod:`printprep.hook.gcode_file`).  While
a hook runs, the variable PRINTPREP_IN_HOOK is set, and a hook that finds it set does nothing: a
slicer started by a hook cannot start it again.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.check.catalogue import finding
from printprep.types import Finding
from printprep.version import __version__

if TYPE_CHECKING:
    from printprep.gcode.printed import Printed
    from printprep.types import Lean
    from printprep.verify.part_3mf import ComputedPart

IN_HOOK = "PRINTPREP_IN_HOOK"
_SAME_SIZE_MM = 1.0


@dataclass(frozen=True, eq=False)
class JudgedPrint:
    """A G-code as it was judged.

    part : the part it was compared with, moved to where it was printed, or None.
    """

    printed: Printed
    lean: Lean
    part: ComputedPart | None
    findings: tuple[Finding, ...]


def already_running() -> bool:
    """Whether this is a hook that a hook's own slicer started."""
    return IN_HOOK in os.environ


@contextmanager
def guarded() -> Iterator[None]:
    """Marks everything started meanwhile as started by a hook."""
    os.environ[IN_HOOK] = "1"
    try:
        yield
    finally:
        del os.environ[IN_HOOK]


def judge(gcode: Path, *, lean: Lean, part: Path | None = None) -> JudgedPrint:
    """Measure a G-code; with a part, compare it with the figures that carries.

    lean : what it must stand; a part brings its own.

    Raises InputError where the G-code or the part cannot be read.
    """
    from printprep.check.registry import sorted_findings
    from printprep.verify.part_3mf import computed_part
    from printprep.verify.rules import compare

    carried = None if part is None else computed_part(part)
    printed = measured(gcode)
    findings = list(_objects(printed))
    if carried is None:
        findings += tips(printed, lean)
    else:
        lean = carried.lean
        carried = moved_to(carried, printed)
        if _alike(carried, printed):
            printed = measured(gcode, carried)
            findings += compare(carried, printed)
        else:
            findings += [_elsewhere(carried, printed), *tips(printed, lean)]
    return JudgedPrint(printed, lean, carried, sorted_findings(findings))


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
    """A G-code's figures; what it does not say of the filament, the slicer's environment may."""
    from printprep.gcode.measure import measure_gcode

    cavities, bodies = ((), ()) if part is None else (part.cavities, part.bodies)
    printed = measure_gcode(gcode, cavities=cavities, bodies=bodies)
    slicer_summary = printed.slicer_summary.settings
    diameter = None if "filament_diameter" in slicer_summary else _setting("FILAMENT_DIAMETER")
    density = None if "filament_density" in slicer_summary else _setting("FILAMENT_DENSITY")
    if diameter is None and density is None:
        return printed
    return measure_gcode(
        gcode, cavities=cavities, bodies=bodies, diameter_mm=diameter, density_g_cm3=density
    )


def tips(printed: Printed, lean: Lean) -> Iterator[Finding]:
    """Whether a print would tip at the lean."""
    from printprep.verify.rules import printed_tilt

    yield from printed_tilt(
        printed,
        lean,
        promised_deg=lean.angle_deg,
        fix="Print it with a brim that stays on, or hollow it: printprep hollow.",
    )


def notes(judged: JudgedPrint) -> list[str]:
    """What is written into the G-code: "key = value", nothing of the machine or the time."""
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
        "stands": "yes" if tilt >= judged.lean.angle_deg else "no",
        "left_out": ", ".join(printed.left_out) or "nothing",
    }
    if judged.part is not None:
        lines["computed_mass_g"] = f"{judged.part.mass_g:.3f}"
        lines["in_cavities_mm3"] = f"{printed.in_cavities_mm3:.2f}"
    lines["findings"] = ", ".join(item.rule for item in judged.findings) or "none"
    return [f"{key} = {value}" for key, value in lines.items()]


def moved_to(part: ComputedPart, printed: Printed) -> ComputedPart:
    """The part moved over the bed to where the print is."""
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


def same_size(size_mm: np.ndarray, printed: Printed) -> bool:
    """Whether a print is as large as a model of that size, to about two lines."""
    return bool((np.abs(np.ptp(printed.bounds_mm, axis=0) - size_mm) <= _SAME_SIZE_MM).all())


def _alike(part: ComputedPart, printed: Printed) -> bool:
    return same_size(part.size_mm, printed)


def _elsewhere(part: ComputedPart, printed: Printed) -> Finding:
    sizes = " × ".join(f"{side:.1f}" for side in np.ptp(printed.bounds_mm, axis=0))
    return finding(
        "another-print",
        f"The G-code prints {sizes} mm, which is not the size of {part.file.name}: "
        "nothing else of it was compared.",
        "Slice that file alone, neither turned nor scaled.",
    )


def _objects(printed: Printed) -> Iterator[Finding]:
    if len(printed.objects) > 1:
        yield finding(
            "several-objects",
            f"The G-code prints {len(printed.objects)} objects; they are weighed and balanced "
            "as one.",
            "Export them one by one to judge each.",
        )


def _setting(key: str) -> float | None:
    """The first extruder's value of a print setting, as the slicer gives it to its scripts."""
    value = os.environ.get(f"SLIC3R_{key}", "").split(",")[0]
    try:
        number = float(value)
    except ValueError:
        return None
    return number if number > 0 else None
