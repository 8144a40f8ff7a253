"""The method, from a model to a part: read, repair, voxelize, solve, carve, check."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from printprep.progress import SILENT, Progress, Stopwatch
from printprep.types import Advice, HollowResult, Lean

if TYPE_CHECKING:
    import trimesh

    from printprep.density.outcome import PaperSolver
    from printprep.density.program import BasePolicy
    from printprep.profiles import Profile
    from printprep.types import Fill, Model, Solid, Supports

Objective = Literal["lean", "paper"]


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
    resolution: int = 64,
    lean: float | str | Lean | None = None,
    objective: Objective = "lean",
    solver: PaperSolver = "plane",
    device: str = "cpu",
    base: BasePolicy = "auto",
    self_support: bool | None = None,
    drains: int | None = None,
    drain_diameter_mm: float | None = None,
    fill: Fill = "cavity",
    slicer: Path | None = None,
    progress: Progress = SILENT,
) -> HollowResult:
    """Hollow a model: the lightest part that stands at the lean asked for.

    Parameters
    ----------
    model : a file (STL, OBJ, PLY, GLB, 3MF; NPZ, NPY, PT for voxels) or a trimesh.Trimesh.
    profile : name or path of a profile, or one already loaded;  overrides : dotted keys on top.
    units : of the file: mm, cm, m, in;  up : the file's axis that points up.
    scale, height_mm, size_mm : at most one: a factor, the height, or the longest side.
    pose : K, to lay the model, as placed so far, into its K-th steadiest stable pose.
    resolution : voxels along the longest side for the optimization.
    lean : degrees at which the part must stand, or "15@90" for 15° toward the azimuth of 90°;
        None takes the profile's.
    objective : "lean", the linear program, or "paper", DensiCrafter's objective solved as a plane.
    solver : of the paper's objective: "plane", exact, or "adam", as the paper descends, on a torch
        ``device`` ("cpu", "cuda").
    base : whether material may be added around the feet.
    self_support : carry the cavities' ceilings from inside; None: where the process needs it (fdm).
    drains : holes in each cavity, at least, 0 for none;  drain_diameter_mm : how wide; None takes
        the profile's.
    fill : "cavity", or "infill": the profile's sparse infill, and dense ballast where it must weigh
        (fdm).
    slicer : the PrusaSlicer that weighs an infill print; None takes one that is found, and where
        none is, the print is estimated.

    Raises
    ------
    UsageError, InputError, GeometryError : see :mod:`printprep.errors`.
    """
    from printprep.cavity.surface import cavity_surface
    from printprep.check import CheckContext, run_rules
    from printprep.density.program import Program
    from printprep.drainage.drainer import Drainer
    from printprep.grid.depth import measure_depths
    from printprep.grid.domain import weigh_interior
    from printprep.infill.options import check_fill
    from printprep.mesh.repair import repair
    from printprep.pipeline.alternative_fill import alternative_fill
    from printprep.pipeline.cavity import settle_lean, settle_paper
    from printprep.pipeline.infill import infilled, slicer_at_hand
    from printprep.profiles import load_profile
    from printprep.stand.lean import lean_of
    from printprep.stand.poses import stable_poses
    from printprep.stand.stability import stability
    from printprep.supports.policy import supported, supports_wanted

    settings = load_profile(profile, {**(overrides or {}), **drain_keys(drains, drain_diameter_mm)})
    asked = lean_of(lean, settings.stability.lean_deg)
    carried = supports_wanted(self_support, settings)
    _check_resolution(resolution)
    _check_solver(objective, solver, device)
    check_fill(fill, settings, objective=objective, self_support=bool(self_support), slicer=slicer)
    clock = Stopwatch(progress)
    with clock.stage("read"):
        placed = placed_model(model, units, up, scale, height_mm, size_mm)
    with clock.stage("repair"):
        solid = repair(placed)
        if pose is not None:
            placed, solid = _posed(placed, solid, pose)
    if fill == "infill":
        return infilled(
            placed,
            solid,
            settings,
            asked,
            resolution=resolution,
            base=base,
            slicer=slicer_at_hand(slicer),
            clock=clock,
        )
    with clock.stage("voxelize"):
        depths = measure_depths(
            solid,
            resolution=resolution,
            wall_mm=settings.wall_mm,
            min_feature_mm=settings.min_feature_mm,
            margin_mm=settings.stability.base_growth_max_mm,
        )
    with clock.stage("cavity"):
        hollowable_volume = cavity_surface(solid.manifold, depths.field, settings.wall_mm)
    supports = None
    if carried and not hollowable_volume.is_empty():
        with clock.stage("supports"):
            hollowable_volume, supports = supported(hollowable_volume, settings)
        settings = _with_free_supports(settings, supports)
    with clock.stage("base"):
        program = Program(
            solid.manifold, weigh_interior(solid, depths, hollowable_volume), settings
        )
        choice = program.choose(base, asked)
    drainer = Drainer(settings) if settings.drain.count else None
    with clock.stage("solve"):
        if objective == "paper":
            found = settle_paper(solid, hollowable_volume, program, choice, solver, device, drainer)
        else:
            found = settle_lean(solid, hollowable_volume, program, choice, asked, drainer)
        density, part, standing = found.density, found.part, found.stability
    advice = None
    if density.reachable_deg is not None:
        with clock.stage("advice"):
            tilts = tuple(found.tilt_deg for found in stable_poses(solid.manifold))
            advice = Advice(program.growth_that_reaches(asked), tilts)
    first_layer = settings.printer.first_layer_mm
    with clock.stage("check"):
        context = CheckContext(
            part=part.manifold,
            outside=part.outside,
            cavities=part.cavities,
            stability=standing,
            lean=asked,
            repair=solid.repair,
            hollowed=True,
            reachable_deg=density.reachable_deg,
            advice=advice,
            drainage=found.drainage,
        )
        findings = run_rules(context, settings)
        before = stability(solid.manifold, first_layer)
    with clock.stage("other way"):
        other = alternative_fill(fill, solid, depths, settings, choice.base, asked)
    grams_per_mm3 = settings.material.density_g_cm3 / 1000
    return HollowResult(
        model=placed,
        solid=solid,
        part=part,
        profile=settings,
        density=density,
        stability_solid=before,
        stability=standing,
        lean=asked,
        solid_mass_g=solid.manifold.volume() * grams_per_mm3,
        mass_g=part.manifold.volume() * grams_per_mm3,
        wall_min_mm=None if context.wall is None else context.wall.value_mm,
        findings=findings,
        advice=advice,
        supports=supports,
        drainage=found.drainage,
        alternative_fill=other,
        seconds=clock.seconds,
    )


def drain_keys(count: int | None, diameter_mm: float | None) -> dict[str, object]:
    """The profile keys that change the drains; None leaves the profile's."""
    keys = {"drain.count": count, "drain.diameter_mm": diameter_mm}
    return {key: value for key, value in keys.items() if value is not None}


def placed_model(
    model: str | Path | trimesh.Trimesh,
    units: str | None,
    up: str,
    scale: float | None,
    height_mm: float | None,
    size_mm: float | None,
) -> Model:
    """A file or mesh as triangles on the bed; parameters as for :func:`hollow`."""
    from printprep.generators.model import read_model
    from printprep.generators.read import SUFFIXES as VOXEL_SUFFIXES
    from printprep.mesh.place import place
    from printprep.mesh.read import from_trimesh, read_mesh

    if isinstance(model, str | Path):
        path = Path(model)
        voxels = path.suffix.lower() in VOXEL_SUFFIXES
        raw = read_model(path) if voxels else read_mesh(path, units)
    else:
        raw = from_trimesh(model, units=units)
    return place(raw, up=up, scale=scale, height_mm=height_mm, size_mm=size_mm)


def _posed(placed: Model, solid: Solid, number: int) -> tuple[Model, Solid]:
    """Model and solid in the stable pose of this number, the steadiest being 1."""
    from printprep.errors import UsageError
    from printprep.stand.poses import in_pose, stable_poses

    poses = stable_poses(solid.manifold)
    if not 1 <= number <= len(poses):
        known = ", ".join(f"{k} ({p.tilt_deg:.0f}°)" for k, p in enumerate(poses, start=1))
        raise UsageError(
            f"{solid.name} has no stable pose {number}.",
            f"It has these, with the lean each stands: {known}." if poses else None,
        )
    manifold, move = in_pose(solid.manifold, poses[number - 1])
    placement = move @ solid.placement
    vertices = placed.vertices @ move[:3, :3].T + move[:3, 3]
    return (
        replace(placed, vertices=vertices, placement=placement),
        replace(solid, manifold=manifold, placement=placement),
    )


def _with_free_supports(profile: Profile, supports: Supports) -> Profile:
    """The profile without the key that keeps a slicer's supports out of cavities, once none goes.

    The key costs the outside its supports where they would rest on the model.
    """
    if supports.unsupported_mm2 > 0 or supports.islands:
        return profile
    kept = dict(profile.slicer.object_settings)
    kept.pop("support_material_buildplate_only", None)
    slicer = profile.slicer.model_copy(update={"object_settings": kept})
    return profile.model_copy(update={"slicer": slicer})


def _check_solver(objective: str, solver: str, device: str) -> None:
    from printprep.errors import UsageError

    if objective != "paper" and solver != "plane":
        raise UsageError(
            "The lean program is solved exactly; a solver belongs to the paper's objective.",
            "Leave --solver out, or ask for --objective paper.",
        )
    if solver == "plane" and device != "cpu":
        raise UsageError("Only the solver adam runs on another device.", "Add --solver adam.")


def _check_resolution(resolution: int) -> None:
    from printprep.errors import UsageError

    if not 8 <= resolution <= 512:
        raise UsageError(f"A resolution of {resolution} is not between 8 and 512 voxels.")
