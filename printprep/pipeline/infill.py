"""The slicer's infill instead of a cavity, with dense ballast where weight is needed."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.check.catalogue import finding
from printprep.infill.ballast import estimated_ballast, weighed_ballast
from printprep.infill.estimate import infill_program, measured_depths, sparse_share
from printprep.infill.trial_print import TrialSlicer
from printprep.output.prusa_keys import layers, lines
from printprep.pipeline.filled import Filled
from printprep.slicer.child import INSTALL_HINT
from printprep.slicer.process import slicer_if_any
from printprep.types import Finding, Infill

if TYPE_CHECKING:
    from printprep.infill.ballast import Ballasted
    from printprep.pipeline.options import FillOptions
    from printprep.pipeline.prepare import Prepared
    from printprep.progress import Stopwatch
    from printprep.types import Lean


def fill_with_infill(
    prepared: Prepared, options: FillOptions, lean: Lean, clock: Stopwatch
) -> Filled:
    """The lightest print with sparse infill that stands at the lean.

    If there is a slicer, it weighs the prints; otherwise they are estimated, and a finding tells
    so.
    """
    solid, profile = prepared.solid, prepared.profile
    assert profile.infill is not None  # see :func:`printprep.infill.options.check_infill`
    slicer = slicer_if_any(options.slicer)
    sparse = sparse_share(profile.infill)
    with clock.stage("voxelize"):
        depths = measured_depths(solid, profile, options.resolution)
        program = infill_program(solid, depths, profile)
    ballasted: Ballasted | None = None
    trial_slicer = None if slicer is None else TrialSlicer(slicer, profile)
    if trial_slicer is not None:
        with clock.stage("slice"):
            ballasted = weighed_ballast(solid, program, options.base, lean, sparse, trial_slicer)
    weighed_with = trial_slicer if ballasted is not None else None
    if ballasted is None:
        with clock.stage("solve"):
            choice = program.choose(options.base, lean)
            ballasted = estimated_ballast(solid, program, choice, sparse)
    grams_per_mm3 = profile.material.density_g_cm3 / 1000
    infill = Infill(
        pattern=profile.infill.pattern,
        density=profile.infill.density,
        perimeters=lines(profile),
        layers=layers(profile),
        ballast=ballasted.ballast,
        ballast_g=ballasted.ballast_mm3 * grams_per_mm3,
        moments=ballasted.moments,
        slicer=None if weighed_with is None else weighed_with.slicer.name,
        slices=0 if trial_slicer is None else trial_slicer.slices,
    )
    estimated = _only_estimated(trial_slicer is not None)
    return Filled(
        profile=profile,
        depths=depths,
        program=program,
        density=ballasted.density,
        part=ballasted.part,
        stability=ballasted.stability,
        volume_mm3=float(ballasted.moments[0]),
        infill=infill,
        findings=() if weighed_with is not None else (estimated,),
    )


def _only_estimated(has_slicer: bool) -> Finding:
    if has_slicer:
        why, fix = "A body does not touch the bed", "Give it a base (--base auto)."
    else:
        why, fix = "No slicer was found", INSTALL_HINT
    return finding(
        "infill-estimated",
        f"{why}: mass and tilt angle are estimated, not measured in the G-code.",
        fix,
    )
