"""Replaces a G-code by one of the hollowed model, sliced with the settings in the G-code.

A G-code does not tell what was sliced, only what it prints.  So the solid model is sliced first.
Where its print differs from the G-code, feature by feature, the G-code has something that slicing
again would lose (other objects, modifiers, painting, object settings, another size), and it stays
unchanged.
"""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from printprep.errors import InputError, ToolError
from printprep.gcode.modal_state import numbers
from printprep.hook.gcode_file import replace_content
from printprep.hook.judge import JudgedPrint, guarded, measured, notes, same_size, tips
from printprep.pipeline.options import AS_IN_FILE, Placement
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from manifold3d import Manifold

    from printprep.gcode.printed import Printed
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.slicer.process import Slicer
    from printprep.verify.part_3mf import ComputedPart

# Share of all material: another place on the bed changes less than this, a modifier more.
_SAME_SHARE = 0.03


@dataclass(frozen=True, eq=False)
class Resliced:
    """A G-code that was replaced: its print before and after."""

    before: Printed
    after: JudgedPrint


def reslice(
    gcode: Path,
    model: Path,
    *,
    slicer: Path | None = None,
    profile: str = "fdm-pla-0.4",
    lean: str | None = None,
    placement: Placement = AS_IN_FILE,
    progress: Progress = SILENT,
) -> Resliced:
    """Hollow a model and replace a G-code by the print of the part.

    Parameters
    ----------
    profile : the limits; settings in the G-code come first;  lean : as in ``hollow``.
    placement : how the model was placed when it was sliced.

    Raises
    ------
    InputError : the G-code cannot be sliced again without a loss;  ToolError : the slicer failed,
        or its print differs from the computed part.  The G-code is then unchanged.
    """
    from printprep.pipeline.hollow import hollow_with
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import prepare
    from printprep.profiles import load_profile
    from printprep.slicer.process import find_slicer

    before = measured(gcode)
    _refuse_what_would_be_lost(gcode, before)
    program = find_slicer(slicer)
    limits = load_profile(profile, overrides_from(before.slicer_summary.settings))
    solid = prepare(model, limits, placement, progress).solid.manifold
    if not same_size(np.ptp(np.reshape(solid.bounding_box(), (2, 3)), 0), before):
        raise InputError(
            f"{gcode.name} is unchanged: it prints another size than {model.name}.",
            "Give --up, --units and the size that was sliced. A model that was turned or scaled in "
            "the slicer cannot be used.",
        )
    at = (before.bounds_mm.mean(axis=0)[0], before.bounds_mm.mean(axis=0)[1])
    with guarded(), tempfile.TemporaryDirectory(prefix="printprep-") as name:
        folder = Path(name)
        settings = _density(before, limits)
        with progress.stage("slice-solid"):
            plain = _sliced_as_it_is(program, solid, at, settings, gcode, folder)
        _refuse_another(gcode, model, before, plain)
        result = hollow_with(model, limits, placement, FillOptions(lean=lean), progress)
        with progress.stage("slice"):
            new, judged = _sliced_hollow(program, result, at, settings, gcode, folder)
        _refuse_unsound(gcode, before, judged)
        replace_content(gcode, new, [*notes(judged), f"replaced_mass_g = {before.mass_g:.3f}"])
    return Resliced(before, judged)


def overrides_from(settings: Mapping[str, str]) -> dict[str, object]:
    """The settings of a G-code as profile keys.  Raises InputError if it carries none."""
    nozzle, layer = numbers(settings, "nozzle_diameter"), numbers(settings, "layer_height")
    if not (nozzle and layer):
        raise InputError(
            "The G-code is unchanged: it carries no PrusaSlicer settings.",
            "Use the hook from PrusaSlicer, or hollow the model first with `printprep hollow`.",
        )
    keys: dict[str, object] = {
        "printer.nozzle_mm": nozzle[0],
        "printer.layer_height_mm": layer[0],
        "printer.first_layer_mm": _first_layer(settings, layer[0]),
        # The slicer writes automatic widths only into the comments at the head of the G-code.
        "printer.line_width_mm": next(
            iter(numbers(settings, "perimeters extrusion width")), 1.125 * nozzle[0]
        ),
    }
    density = numbers(settings, "filament_density")
    if density and density[0] > 0:
        keys["material.density_g_cm3"] = density[0]
    bed = _bed(settings)
    if bed is not None:
        keys["printer.bed_mm"] = bed
    return keys


def _first_layer(settings: Mapping[str, str], layer_mm: float) -> float:
    first = numbers(settings, "first_layer_height")
    if not first:
        return layer_mm
    percent = settings["first_layer_height"].strip().endswith("%")
    return first[0] / 100 * layer_mm if percent else first[0]


def _bed(settings: Mapping[str, str]) -> list[float] | None:
    corners = [corner.split("x") for corner in settings.get("bed_shape", "").split(",")]
    height = numbers(settings, "max_print_height")
    if len(corners) < 3 or not height or any(len(corner) != 2 for corner in corners):
        return None
    extent = np.ptp(np.array(corners, dtype=float), axis=0)
    return [float(extent[0]), float(extent[1]), height[0]]


def _refuse_what_would_be_lost(gcode: Path, printed: Printed) -> None:
    lost = []
    if len(printed.objects) > 1:
        lost.append(f"{len(printed.objects)} objects")
    if "wipe tower" in printed.feature_mass_g:
        lost.append("a wipe tower")
    if lost:
        raise InputError(
            f"{gcode.name} is unchanged: it prints {' and '.join(lost)}, which would be lost.",
            "Export each object by itself, with one extruder.",
        )


def _refuse_another(gcode: Path, model: Path, before: Printed, plain: Printed) -> None:
    limit = _SAME_SHARE * before.filament_mm3
    volumes, plain_volumes = before.feature_volume_mm3, plain.feature_volume_mm3
    differ = [
        feature
        for feature in sorted({*volumes, *plain_volumes} - {"custom", "skirt", "brim"})
        if abs(volumes.get(feature, 0.0) - plain_volumes.get(feature, 0.0)) > limit
    ]
    if differ:
        raise InputError(
            f"{gcode.name} is unchanged: {model.name} with the same settings prints differently "
            f"({', '.join(differ)}), so modifiers, painting, object settings or other objects "
            "would be lost.",
            "Hollow the model first with `printprep hollow`, and slice the 3MF with these "
            "settings.",
        )


def _refuse_unsound(gcode: Path, before: Printed, judged: JudgedPrint) -> None:
    faults = [item.message for item in judged.findings if item.severity == "error"]
    faults += [item.message for item in judged.findings if item.rule == "filament-count"]
    heavier = judged.printed.filament_mm3 >= before.filament_mm3
    if heavier and not list(tips(before, judged.lean)):
        faults.append("It takes no less filament, and the solid print stands already.")
    if faults:
        raise ToolError(
            f"{gcode.name} is unchanged: the print of the hollowed part is not good enough.",
            " ".join(faults),
        )


def _density(before: Printed, profile: Profile) -> dict[str, str]:
    if any(numbers(before.slicer_summary.settings, "filament_density")):
        return {}
    return {"filament_density": f"{profile.material.density_g_cm3:g}"}


def _sliced_as_it_is(
    program: Slicer,
    solid: Manifold,
    at: tuple[float, float],
    settings: Mapping[str, str],
    load: Path,
    folder: Path,
) -> Printed:
    from printprep.mesh.write import to_bytes

    model, made = folder / "model.stl", folder / "plain.gcode"
    model.write_bytes(to_bytes(_moved(solid, at), ".stl"))
    program.slice(model, made, settings, load)
    return measured(made)


def _sliced_hollow(
    program: Slicer,
    result: HollowResult,
    at: tuple[float, float],
    settings: Mapping[str, str],
    load: Path,
    folder: Path,
) -> tuple[Path, JudgedPrint]:
    from printprep.check.registry import sorted_findings
    from printprep.verify.rules import compare

    made = folder / "hollow.gcode"
    part = _write_part(result, at, folder / "hollow.3mf")
    program.slice(part.file, made, settings, load)
    printed = measured(made, part)
    return made, JudgedPrint(printed, part.lean, part, sorted_findings(compare(part, printed)))


def _write_part(result: HollowResult, at: tuple[float, float], target: Path) -> ComputedPart:
    """The part as a 3MF that puts it in the place of the print."""
    from printprep.mesh.quantize import quantized
    from printprep.output.item import solid_item
    from printprep.output.numbers import to_text
    from printprep.output.part_file import JSON_PART
    from printprep.threemf.write import write_3mf
    from printprep.verify.part_3mf import computed_part

    x0, y0, _, x1, y1, _ = result.solid.manifold.bounding_box()
    at_mm = (float(at[0] - (x0 + x1) / 2), float(at[1] - (y0 + y1) / 2))
    part = quantized(result.part.manifold)
    item = solid_item(part, result.part.name, result.profile, at_mm, blocker=result.blocker)
    figures = {JSON_PART: to_text(result.figures().to_json()).encode("ascii")}
    target.write_bytes(write_3mf([item], attachments=figures))
    return computed_part(target)


def _moved(manifold: Manifold, at: tuple[float, float]) -> Manifold:
    x0, y0, _, x1, y1, _ = manifold.bounding_box()
    moved: Manifold = manifold.translate((at[0] - (x0 + x1) / 2, at[1] - (y0 + y1) / 2, 0.0))
    return moved
