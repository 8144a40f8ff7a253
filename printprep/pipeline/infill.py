"""The way of an infill print, from a solid to a part: room, program, slicer, checks."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from printprep.infill.estimate import infill_program, shell_mm, sparse_share
from printprep.output.prusa_keys import layers, lines

if TYPE_CHECKING:
    from printprep.density.program import BasePolicy
    from printprep.grid.depth import Depths
    from printprep.infill.ballast import Filled
    from printprep.profiles import Profile
    from printprep.progress import Stopwatch
    from printprep.slicer.process import Slicer
    from printprep.types import Finding, HollowResult, Lean, Model, Solid

# The room is weighed, not cut: it need not be as smooth as a cavity.
CELLS_PER_WALL = 2.0


def infilled(
    placed: Model,
    solid: Solid,
    profile: Profile,
    lean: Lean,
    *,
    resolution: int,
    base: BasePolicy,
    slicer: Slicer | None,
    clock: Stopwatch,
) -> HollowResult:
    """The lightest print with sparse infill that stands at the lean.

    slicer : weighs the prints; None: they are estimated.
    """
    from printprep.check import CheckContext, run_rules
    from printprep.check.registry import sorted_findings
    from printprep.infill.ballast import settle_estimated, settle_weighed
    from printprep.infill.test_print import TrialSlicer
    from printprep.pipeline.alternative_fill import alternative_fill
    from printprep.stand.poses import stable_poses
    from printprep.stand.stability import stability
    from printprep.types import Advice, HollowResult, Infill

    assert profile.infill is not None  # see :func:`printprep.infill.options.check_fill`
    sparse = sparse_share(profile.infill)
    with clock.stage("voxelize"):
        depths = measured_depths(solid, profile, resolution)
        program = infill_program(solid, depths, profile)
    found: Filled | None = None
    trial_slicer = None if slicer is None else TrialSlicer(slicer, profile)
    if trial_slicer is not None:
        with clock.stage("slice"):
            found = settle_weighed(solid, program, base, lean, sparse, trial_slicer)
    weighed = found is not None
    if found is None:
        with clock.stage("solve"):
            found = settle_estimated(solid, program, program.choose(base, lean), sparse)
    advice = None
    if found.density.reachable_deg is not None:
        with clock.stage("advice"):
            tilts = tuple(pose.tilt_deg for pose in stable_poses(solid.manifold))
            advice = Advice(program.growth_that_reaches(lean), tilts)
    with clock.stage("other way"):
        other = alternative_fill("infill", solid, depths, profile, found.part.base, lean)
    grams = profile.material.density_g_cm3 / 1000
    with clock.stage("check"):
        context = CheckContext(
            part=found.part.manifold,
            outside=found.part.outside,
            cavities=(),
            stability=found.standing,
            lean=lean,
            repair=solid.repair,
            hollowed=True,
            infilled=True,
            reachable_deg=found.density.reachable_deg,
            advice=advice,
        )
        findings = list(run_rules(context, profile))
        if not weighed:
            findings.append(_only_estimated(trial_slicer is not None))
        before = stability(solid.manifold, profile.printer.first_layer_mm)
    return HollowResult(
        model=placed,
        solid=solid,
        part=found.part,
        profile=profile,
        density=found.density,
        stability_solid=before,
        stability=found.standing,
        lean=lean,
        solid_mass_g=solid.manifold.volume() * grams,
        mass_g=float(found.moments[0]) * grams,
        wall_min_mm=None,
        findings=sorted_findings(findings),
        advice=advice,
        seconds=clock.seconds,
        alternative_fill=other,
        infill=Infill(
            pattern=profile.infill.pattern,
            density=profile.infill.density,
            perimeters=lines(profile),
            layers=layers(profile),
            ballast=found.ballast,
            ballast_g=found.ballast_mm3 * grams,
            moments=found.moments,
            slicer=trial_slicer.slicer.name if trial_slicer is not None and weighed else None,
            slices=0 if trial_slicer is None else trial_slicer.slices,
        ),
    )


def measured_depths(solid: Solid, profile: Profile, resolution: int) -> Depths:
    """Depths below a solid's surface, fine where its infill begins."""
    from printprep.grid.depth import measure_depths

    return measure_depths(
        solid,
        resolution=resolution,
        wall_mm=shell_mm(profile),
        min_feature_mm=profile.min_feature_mm,
        margin_mm=profile.stability.base_growth_max_mm,
        cells_per_wall=CELLS_PER_WALL,
    )


def slicer_at_hand(path: Path | None = None) -> Slicer | None:
    """The slicer named, or one that is found; None where there is none to be found.

    Raises ToolError where the one that was named does not answer.
    """
    import os

    from printprep.errors import ToolError
    from printprep.slicer.child import SLICER_VARIABLE
    from printprep.slicer.process import find_slicer

    try:
        return find_slicer(path)
    except ToolError:
        if path is not None or os.environ.get(SLICER_VARIABLE):
            raise
        return None


def _only_estimated(has_slicer: bool) -> Finding:
    from printprep.slicer.child import INSTALL_HINT
    from printprep.types import Finding

    why = "Something of it does not touch the bed" if has_slicer else "No slicer was found"
    fix = "Give it a base (--base auto)." if has_slicer else INSTALL_HINT
    return Finding(
        "infill-estimated",
        "warning",
        f"{why}: what it weighs and how it stands is estimated, not measured in its G-code.",
        fix,
    )
