"""Replace a G-code by one of the hollowed model, sliced with the settings the G-code carries.

A G-code says what was sliced only through what it prints.  So the model is sliced as it is first:
where that is not what the G-code prints, feature by feature, there was more to it (other objects,
modifiers, painting, settings of its own, another size), which slicing anew would lose, and the
G-code is left alone.
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

_SAME_SHARE = 0.03  # of all material: what another place on the bed changes, and no modifier
_LEFT = "the G-code is as it was"


@dataclass(frozen=True, eq=False)
class Resliced:
    """A G-code that was replaced: what it printed, and what it prints now."""

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
    """Hollow a model and put its G-code in place of the one given.

    Parameters
    ----------
    profile : what the G-code's own settings go over;  lean : as ``hollow`` takes it.
    placement : how the model lay when it was sliced.

    Raises
    ------
    InputError : the G-code cannot be sliced anew without loss;  ToolError : the slicer failed, or
        what it made is not the part that was computed.  The G-code is then as it was.
    """
    from printprep.pipeline.hollow import hollow_with
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import prepare
    from printprep.profiles import load_profile
    from printprep.slicer.process import find_slicer

    before = measured(gcode)
    _refuse_what_would_be_lost(gcode, before)
    program = find_slicer(slicer)
    found = load_profile(profile, overrides_from(before.slicer_summary.settings))
    solid = prepare(model, found, placement, progress).solid.manifold
    if not same_size(np.ptp(np.reshape(solid.bounding_box(), (2, 3)), 0), before):
        raise InputError(
            f"{gcode.name}: prints something of another size than {model.name}; {_LEFT}",
            "give --up, --units and the size it was sliced in; turned or scaled in the slicer, "
            "it cannot be found again",
        )
    at = (before.bounds_mm.mean(axis=0)[0], before.bounds_mm.mean(axis=0)[1])
    with guarded(), tempfile.TemporaryDirectory(prefix="printprep-") as name:
        folder = Path(name)
        settings = _density(before, found)
        with progress.stage("slice-solid"):
            plain = _sliced_as_it_is(program, solid, at, settings, gcode, folder)
        _refuse_another(gcode, model, before, plain)
        result = hollow_with(model, found, placement, FillOptions(lean=lean), progress)
        with progress.stage("slice"):
            new, judged = _sliced_hollow(program, result, at, settings, gcode, folder)
        _refuse_unsound(gcode, before, judged)
        replace_content(gcode, new, [*notes(judged), f"replaced_mass_g = {before.mass_g:.3f}"])
    return Resliced(before, judged)


def overrides_from(settings: Mapping[str, str]) -> dict[str, object]:
    """A G-code's settings as keys of a profile.  Raises InputError where it carries none."""
    nozzle, layer = numbers(settings, "nozzle_diameter"), numbers(settings, "layer_height")
    if not (nozzle and layer):
        raise InputError(
            f"The G-code carries no PrusaSlicer settings; {_LEFT}",
            "use the hook from PrusaSlicer, or hollow the model first: printprep hollow",
        )
    found: dict[str, object] = {
        "process": "fdm",
        "printer.nozzle_mm": nozzle[0],
        "printer.layer_height_mm": layer[0],
        "printer.first_layer_mm": _first_layer(settings, layer[0]),
        # Automatic widths are worked out only in the comments at the G-code's head
        "printer.line_width_mm": next(
            iter(numbers(settings, "perimeters extrusion width")), 1.125 * nozzle[0]
        ),
    }
    density = numbers(settings, "filament_density")
    if density and density[0] > 0:
        found["material.density_g_cm3"] = density[0]
    bed = _bed(settings)
    if bed is not None:
        found["printer.bed_mm"] = bed
    return found


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
            f"{gcode.name}: prints {' and '.join(lost)}, which would be lost; {_LEFT}",
            "export each object by itself, with one extruder",
        )


def _refuse_another(gcode: Path, model: Path, before: Printed, plain: Printed) -> None:
    limit = _SAME_SHARE * before.filament_mm3
    mine, other = before.feature_volume_mm3, plain.feature_volume_mm3
    differ = [
        feature
        for feature in sorted({*mine, *other} - {"custom", "skirt", "brim"})
        if abs(mine.get(feature, 0.0) - other.get(feature, 0.0)) > limit
    ]
    if differ:
        raise InputError(
            f"{gcode.name}: {model.name} with the same settings prints differently "
            f"({', '.join(differ)}): modifiers, painting, settings of the object or other objects "
            f"would be lost; {_LEFT}",
            "hollow the model first (printprep hollow), and slice the 3MF with these settings",
        )


def _refuse_unsound(gcode: Path, before: Printed, judged: JudgedPrint) -> None:
    wrong = [item.message for item in judged.findings if item.severity == "error"]
    wrong += [item.message for item in judged.findings if item.rule == "filament-count"]
    heavier = judged.printed.filament_mm3 >= before.filament_mm3
    if heavier and not list(tips(before, judged.lean)):
        wrong.append("It would take more filament, and the print as it is stands.")
    if wrong:
        raise ToolError(f"{gcode.name}: hollow, it is not as computed; {_LEFT}", " ".join(wrong))


def _density(before: Printed, profile: Profile) -> dict[str, str]:
    slicer_summary = numbers(before.slicer_summary.settings, "filament_density")
    if any(slicer_summary):
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
    """The part as a 3MF that puts it where the print was."""
    from printprep.mesh.quantize import quantized
    from printprep.output.item import solid_item
    from printprep.output.numbers import to_text
    from printprep.output.part_file import JSON_PART
    from printprep.threemf.write import write_3mf
    from printprep.verify.part_3mf import computed_part

    x0, y0, _, x1, y1, _ = result.solid.manifold.bounding_box()
    at_mm = (float(at[0] - (x0 + x1) / 2), float(at[1] - (y0 + y1) / 2))
    item = solid_item(quantized(result.part.manifold), result.part.name, result.profile, at_mm)
    figures = {JSON_PART: to_text(result.figures().to_json()).encode("ascii")}
    target.write_bytes(write_3mf([item], attachments=figures))
    return computed_part(target)


def _moved(manifold: Manifold, at: tuple[float, float]) -> Manifold:
    x0, y0, _, x1, y1, _ = manifold.bounding_box()
    moved: Manifold = manifold.translate((at[0] - (x0 + x1) / 2, at[1] - (y0 + y1) / 2, 0.0))
    return moved
