"""One run of one model, as the command, a batch or a service runs it: data in, data out.

``run_job`` reads, hollows, simulates, verifies and writes; what is found decides, by ``fail_on``,
whether anything is written.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from printprep.errors import UsageError
from printprep.pipeline.fills import fill_of
from printprep.pipeline.options import FillOptions, Placement
from printprep.progress import SILENT, Progress

if TYPE_CHECKING:
    from printprep.profiles import Profile
    from printprep.result import HollowResult
    from printprep.types import Drainage, Finding, Severity, SlicerName
    from printprep.verify.run import Verified


@dataclass(frozen=True)
class Job:
    """What is asked of one model.

    profile : name or path of a profile, or one already loaded;  overrides : dotted keys on top.
    output : where the part goes;  written_for : the slicer it is written for.
    plugs : where plugs for its drains go, None for none.
    simulate : let the part go in a physics engine;  verify : slice it and measure the G-code.
    fail_on : write nothing with a finding at least as severe; None writes always.
    """

    model: Path
    output: Path
    profile: str | Path | Profile = "fdm-pla-0.4"
    overrides: Mapping[str, object] = field(default_factory=dict)
    placement: Placement = field(default_factory=Placement)
    options: FillOptions = field(default_factory=FillOptions)
    written_for: SlicerName = "prusa"
    plugs: Path | None = None
    simulate: bool = False
    verify: bool = False
    fail_on: Severity | None = None


@dataclass(frozen=True, eq=False)
class JobResult:
    """What came of a job.

    result : the part, as its file holds it;  findings : those of the part and of its print.
    verified : the print, None where it was not sliced.
    written, plugs : the files written, None where none was.
    """

    result: HollowResult
    findings: tuple[Finding, ...]
    verified: Verified | None
    written: Path | None
    plugs: Path | None

    @property
    def stopped(self) -> bool:
        """Whether a finding kept the part from being written."""
        return self.written is None


def run_job(job: Job, progress: Progress = SILENT) -> JobResult:
    """Run one model from file to file.

    Raises
    ------
    UsageError, InputError, GeometryError, OutputError, ToolError : see :mod:`printprep.errors`.
        Nothing is written then.
    """
    from printprep.check import at_or_above, sorted_findings
    from printprep.output.limits import format_findings
    from printprep.pipeline.hollow import hollow_with
    from printprep.verify.unwritten import verify_result

    profile = check_job(job)
    result = hollow_with(job.model, profile, job.placement, job.options, progress)
    more = [*format_findings(result.profile, job.output, job.written_for)]
    if job.plugs is not None:
        more += _plug_findings(result.drainage, job.plugs)
    result = replace(result, findings=sorted_findings([*result.findings, *more]))
    if job.simulate:
        with progress.stage("simulate"):
            result = _simulated(result)
    verified = verify_result(result, progress=progress) if job.verify else None
    # The print is one slicer's: its findings are told, but do not change the part's own file
    print_findings = () if verified is None else verified.findings
    findings = sorted_findings([*result.findings, *print_findings])
    if job.fail_on is not None and at_or_above(findings, job.fail_on):
        return JobResult(result, findings, verified, None, None)
    with progress.stage("write"):
        plugs = _write(job, result)
    return JobResult(result, findings, verified, job.output, plugs)


def check_job(job: Job) -> Profile:
    """Find out before the long work whether a job can be done; returns its profile.

    Raises UsageError, OutputError or ToolError, as ``run_job`` would after it.
    """
    from printprep.output.limits import check_output
    from printprep.output.manual_settings import check_slicer
    from printprep.pipeline.hollow import check_options
    from printprep.profiles import load_profile
    from printprep.verify.unwritten import check_verifiable

    check_output(job.output)
    if job.output.exists() and job.model.exists() and job.output.samefile(job.model):
        raise UsageError(
            f"{job.output} is the model itself and would be replaced.", "Name another --output."
        )
    profile = load_profile(job.profile, job.overrides)
    check_slicer(profile, job.written_for)
    _check_drains(job, profile)
    fill = fill_of(job.options.fill)
    fill.check_output(job.output.suffix, job.written_for)
    if job.simulate and not fill.solid:
        raise UsageError(
            "The simulation takes the mesh for solid, which a print with infill is not.",
            "Leave out --simulate; --verify measures the tilt angle in the G-code.",
        )
    check_options(profile, job.options)
    if job.verify:
        check_verifiable(job.output, profile)
    return profile


def _check_drains(job: Job, profile: Profile) -> None:
    from printprep.output.limits import check_output

    if not profile.drain.count and (job.plugs is not None or "drain.diameter_mm" in job.overrides):
        what = "--plugs has nothing to plug" if job.plugs is not None else "No hole is that wide"
        raise UsageError(
            f"{what}: profile {profile.name} makes no drains.",
            "Ask for drains with --drains N, or take a profile for resin or powder.",
        )
    if job.plugs is None:
        return
    if job.plugs.suffix.lower() != ".3mf":
        raise UsageError(
            f"{job.plugs}: plugs are written as .3mf.", "Name a file that ends in .3mf."
        )
    check_output(job.plugs)
    for other, what in ((job.output, "the part"), (job.model, "the model")):
        if job.plugs.resolve() == other.resolve():
            raise UsageError(
                f"{job.plugs} is {what} itself and would be replaced.",
                "Name another file for --plugs.",
            )


def _plug_findings(found: Drainage | None, plugs: Path) -> tuple[Finding, ...]:
    """That there is nothing to plug, so that no file is looked for."""
    from printprep.check.catalogue import finding

    if found is not None and found.drains:
        return ()
    return (finding("no-plugs", f"{plugs} was not written: the part has no drains."),)


def _simulated(result: HollowResult) -> HollowResult:
    from printprep.check import sorted_findings
    from printprep.check.simulated import disagreements
    from printprep.stand.trial import trial

    found = trial(result.part.manifold, result.profile.printer.first_layer_mm, result.lean)
    findings = sorted_findings([*result.findings, *disagreements(found)])
    return replace(result, simulation=found, findings=findings)


def _write(job: Job, result: HollowResult) -> Path | None:
    """Write the part and its plugs; returns where the plugs are, None where there are none."""
    from printprep.output.plugs import write_plugs

    result.write(job.output, job.written_for)
    if job.plugs is None or result.drainage is None or not result.drainage.drains:
        return None
    write_plugs(result.part, result.drainage, result.profile, job.plugs)
    return job.plugs
