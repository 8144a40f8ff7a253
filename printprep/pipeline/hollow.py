"""The method from a model to a part: prepare, fill, advise, check."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from printprep.objectives import DEFAULT_OBJECTIVE, PLANE, Solver, check_solver, objective_of
from printprep.pipeline.fills import fill_of
from printprep.pipeline.options import (
    FillOptions,
    Placement,
    VoidPolicy,
    check_resolution,
    drain_keys,
)
from printprep.progress import SILENT, Progress, Stage, Stopwatch
from printprep.side_by_side import side_by_side

if TYPE_CHECKING:
    import trimesh
    from manifold3d import Manifold

    from printprep.check.context import CheckContext
    from printprep.check.walls import Enclosed
    from printprep.density.program import BasePolicy
    from printprep.pipeline.filled import Filled
    from printprep.pipeline.prepare import Prepared
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.types import Advice, AlternativeFill, Finding, Lean, Part, Solid, VaultChoice


def hollow_with(
    model: str | Path | trimesh.Trimesh,
    profile: Profile,
    placement: Placement,
    options: FillOptions,
    progress: Progress = SILENT,
) -> HollowResult:
    """Hollow a model with frozen options: the method, step by step.

    Raises
    ------
    UsageError, InputError, GeometryError, ToolError : see :mod:`printprep.errors`.
    """
    from printprep.check import run_rules, sorted_findings
    from printprep.check.reading import reading_findings
    from printprep.mesh.measure import evaluate
    from printprep.pipeline.alternative_fill import alternative_fill
    from printprep.pipeline.prepare import prepare
    from printprep.pipeline.soundness import check_sound
    from printprep.pipeline.voids import settle_voids
    from printprep.stand.lean import lean_of

    lean = lean_of(options.lean, profile.stability.lean_deg)
    check_options(profile, options)
    clock = Stopwatch(progress)
    prepared = prepare(
        model,
        profile,
        placement,
        clock,
        resolution=options.resolution,
        max_memory_mib=options.max_memory_mib,
    )
    prepared = settle_voids(prepared, options, clock)
    filled = fill_of(options.fill).run(prepared, options, lean, clock)
    drains = filled.drainage.drains if filled.drainage is not None else ()
    advice = advise(prepared, filled, lean, clock)
    with clock.stage("check"):
        context = context_of(prepared, filled, lean, advice)
        evaluate((filled.part.manifold, filled.part.outside, *filled.part.cavities))
        sound = partial(check_sound, filled.part, drains)
        checked: list[Any] = side_by_side([sound, partial(run_rules, context, filled.profile)])
        rule_findings: tuple[Finding, ...] = checked[1]
        read_findings = reading_findings(prepared.model.notes)
    with clock.stage("alternative"):
        alternative = alternative_fill(options.fill, prepared, filled, lean)
    findings = sorted_findings([*read_findings, *rule_findings, *filled.findings])
    return result_of(prepared, filled, context, findings, alternative, clock.seconds)


def hollow(
    model: str | Path | trimesh.Trimesh,
    *,
    profile: str | Path | Profile = "fdm-pla-0.4",
    overrides: Mapping[str, object] | None = None,
    units: str | None = None,
    up: str = "+z",
    scale: float | None = None,
    height_mm: float | None = None,
    size_mm: float | None = None,
    pose: int | None = None,
    partial: bool = False,
    plate: int | None = None,
    item: str | None = None,
    resolution: int = 64,
    lean: float | str | Lean | None = None,
    objective: str = DEFAULT_OBJECTIVE,
    solver: str = PLANE,
    device: str = "cpu",
    base: BasePolicy = "auto",
    voids: VoidPolicy = "fill",
    vaults: VaultChoice | None = None,
    drains: int | None = None,
    drain_diameter_mm: float | None = None,
    fill: str = "cavity",
    slicer: Path | None = None,
    max_memory_mib: float | None = None,
    progress: Progress = SILENT,
) -> HollowResult:
    """Hollow a model: the lightest part that stands at the requested lean.

    Parameters
    ----------
    model : a file (STL, OBJ, PLY, GLB, 3MF; NPZ, NPY, PT for voxels) or a trimesh.Trimesh.
    profile : name or path of a profile, or one already loaded.
    overrides : profile keys to change, a key in a table as "table.key".
    units : unit of the file: mm, cm, m, in;  up : axis of the file that points up.
    scale, height_mm, size_mm : at most one: a factor, the height, or the longest side.
    pose : K puts the placed model into its K-th steadiest stable pose.
    partial : take the facets that are there from a file that is cut short.
    plate : number of the plate of a 3MF project;  item : name or number of one object of a 3MF.
    resolution : voxels along the longest side, for the optimization.
    lean : degrees at which the part must stand, or "15@90" for 15° toward azimuth 90°; None takes
        the profile's.
    objective : a name in :data:`printprep.objectives.OBJECTIVES`: "lean", the linear program, or
        "paper", DensiCrafter's objective.
    solver : how the paper's objective is solved: "plane", exactly, or "adam", by gradient descent
        as in the paper, on a torch ``device`` ("cpu", "cuda").
    base : whether material may be added around the feet: "auto" (where that saves material),
        "never", "always".
    voids : "fill" fills the sealed voids that the model brings, but for those that hold a body of
        their own, before anything is hollowed; "keep" leaves all of them.
    vaults : whose overhang rule the vaults keep that carry the ceilings of cavities: "printer",
        "slicer", or "none" for no vaults.  None takes the printer's if the process needs vaults.
        Such a part is written as a 3MF for PrusaSlicer, OrcaSlicer or BambuStudio, with a support
        blocker.
    drains : least number of drain holes in each cavity, 0 for none;  drain_diameter_mm : their
        diameter.  None takes the profile's.
    fill : a name in :data:`printprep.pipeline.fills.FILLS`: "cavity", or "infill", the profile's
        sparse infill with dense ballast where weight is needed (filament only).
    slicer : the PrusaSlicer that weighs an infill print.  None uses the one installed; without one
        the print is estimated.
    max_memory_mib : a model whose estimate exceeds this is refused; None takes what the machine
        has free.

    Raises
    ------
    UsageError, InputError, GeometryError, ToolError : see :mod:`printprep.errors`.
    """
    from printprep.profiles import load_profile

    settings = load_profile(profile, {**(overrides or {}), **drain_keys(drains, drain_diameter_mm)})
    placement = Placement(units, up, scale, height_mm, size_mm, pose, partial, plate, item)
    options = FillOptions(
        fill=fill,
        lean=lean,
        resolution=resolution,
        objective=objective,
        solver=Solver(solver, device),
        base=base,
        voids=voids,
        vaults=vaults,
        slicer=slicer,
        max_memory_mib=max_memory_mib,
    )
    return hollow_with(model, settings, placement, options, progress)


def check_options(profile: Profile, options: FillOptions) -> None:
    """Raise UsageError for options that exclude each other, or that the profile excludes."""
    from printprep.stand.lean import lean_of

    lean_of(options.lean, profile.stability.lean_deg)
    check_resolution(options.resolution)
    check_solver(objective_of(options.objective), options.solver)
    fill_of(options.fill).check(profile, options)


def advise(prepared: Prepared, filled: Filled, lean: Lean, progress: Progress) -> Advice | None:
    """What would make a lean feasible that is out of reach; None where it is feasible."""
    from printprep.stand.poses import stable_poses
    from printprep.types import Advice

    if filled.density.reachable_deg is None:
        return None
    with progress.stage("advice"):
        tilts_deg = tuple(pose.tilt_deg for pose in stable_poses(prepared.solid.manifold))
        return Advice(filled.program.growth_that_reaches(lean), tilts_deg)


def context_of(
    prepared: Prepared, filled: Filled, lean: Lean, advice: Advice | None
) -> CheckContext:
    """The part as the rules look at it: the triangles that will be written, as of any file.

    So whatever ``check`` says of the file, ``hollow`` says too.  Walls are measured from the
    cavities to the surface of the model.
    """
    from printprep.check import CheckContext
    from printprep.check.context import separated
    from printprep.mesh.quantize import quantized_arrays
    from printprep.types import Model

    part, solid = filled.part, prepared.solid
    outside, sealed = separated(part.manifold)
    opened = bool(filled.drainage is not None and filled.drainage.drains)
    vertices, faces = quantized_arrays(part.manifold)
    return CheckContext(
        part=part.manifold,
        outside=outside,
        cavities=sealed,
        drained=part.cavities if opened else (),
        walls=walls_of(part, solid, sealed if not opened else part.cavities),
        raw=Model(vertices, faces, part.placement, part.name),
        voids=prepared.voids,
        stability=filled.stability,
        lean=lean,
        repair=prepared.solid.repair,
        hollowed=True,
        infilled=filled.infill is not None,
        reachable_deg=filled.density.reachable_deg,
        advice=advice,
        drainage=filled.drainage,
        blocker=filled.blocker,
    )


def walls_of(part: Part, solid: Solid, cavities: Sequence[Manifold]) -> tuple[Enclosed, ...]:
    """Between what the walls of a part are measured: its cavities, its outside, voids that stay.

    cavities : of the part as it will be written, or before drain holes opened them.
    """
    from printprep.check.context import separated
    from printprep.check.walls import Enclosed

    around, holding = separated(part.outside)
    pairs = [Enclosed(around, (*cavities, *holding) if holding else tuple(cavities))]
    if holding:
        pairs.append(Enclosed(part.outside, part.cavities))
    if part.kept:
        cut = tuple(
            cavity
            for cavity in part.cavities
            if not any((cavity ^ void).volume() > 0 for void in part.kept)
        )
        pairs.append(Enclosed(solid.manifold, cut))
    return tuple(pairs)


def result_of(
    prepared: Prepared,
    filled: Filled,
    context: CheckContext,
    findings: tuple[Finding, ...],
    alternative: AlternativeFill | None,
    seconds: Mapping[Stage, float],
) -> HollowResult:
    """Everything that ``hollow`` returns, as one value."""
    from printprep.output.colours import carried_paint
    from printprep.result import HollowResult, Workings
    from printprep.stand.stability import stability

    solid, profile = prepared.solid, filled.profile
    grams_per_mm3 = profile.material.density_g_cm3 / 1000
    return HollowResult(
        model=prepared.model,
        solid=solid,
        part=filled.part,
        profile=profile,
        density=filled.density,
        stability_solid=stability(solid.whole, profile.printer.first_layer_mm),
        stability=filled.stability,
        lean=context.lean,
        solid_mass_g=solid.whole.volume() * grams_per_mm3,
        mass_g=filled.volume_mm3 * grams_per_mm3,
        wall_min_mm=None if context.wall is None else context.wall.value_mm,
        findings=findings,
        advice=context.advice,
        supports=filled.supports,
        blocker=filled.blocker,
        drainage=filled.drainage,
        infill=filled.infill,
        alternative_fill=alternative,
        paint=carried_paint(prepared.model, filled.part, solid.repair),
        seconds={str(stage): value for stage, value in seconds.items()},
        workings=Workings(filled.program, filled.depths, filled.deep, filled.hollowable),
    )
