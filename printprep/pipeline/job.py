"""One run of one model, for the command, a batch or a service: data in, data out.

``run_job`` reads, hollows, simulates, verifies and writes.  It writes nothing if a finding reaches
the level ``fail_on``.
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
    from printprep.types import Drainage, Finding, Severity, SlicerName, VaultChoice
    from printprep.verify.run import Verified


@dataclass(frozen=True)
class Job:
    """One model and what to do with it.

    profile : name or path of a profile, or one already loaded.
    overrides : profile keys to change, a key in a table as "table.key".
    output : the file for the part;  written_for : the slicer it is written for.
    plugs : the file for plugs of its drain holes, None for no plugs.
    report : the file for a page about the part, which the caller writes; None for no page.
    simulate : simulate the part in a physics engine;  verify : slice it and measure the G-code.
    fail_on : write nothing if a finding is at least this severe; None writes always.
    """

    model: Path
    output: Path
    profile: str | Path | Profile = "fdm-pla-0.4"
    overrides: Mapping[str, object] = field(default_factory=dict)
    placement: Placement = field(default_factory=Placement)
    options: FillOptions = field(default_factory=FillOptions)
    written_for: SlicerName = "prusa"
    plugs: Path | None = None
    report: Path | None = None
    simulate: bool = False
    verify: bool = False
    fail_on: Severity | None = None


@dataclass(frozen=True, eq=False)
class JobResult:
    """The result of a job.

    result : the part, as its file holds it;  findings : those of the part and of its print.
    verified : the print, None if it was not sliced.
    written, plugs : the files that were written, None if none was.
    """

    result: HollowResult
    findings: tuple[Finding, ...]
    verified: Verified | None
    written: Path | None
    plugs: Path | None

    @property
    def stopped(self) -> bool:
        """Whether a finding reached ``fail_on``, so that the part was not written."""
        return self.written is None


def run_job(job: Job, progress: Progress = SILENT) -> JobResult:
    """Run one model from file to file.

    Raises
    ------
    UsageError, InputError, GeometryError, OutputError, ToolError : see :mod:`printprep.errors`.
        Then nothing is written.
    """
    from printprep.check import at_or_above, sorted_findings
    from printprep.output.colours import colour_findings
    from printprep.output.limits import carries_blocker, format_findings, vault_findings
    from printprep.pipeline.hollow import hollow_with
    from printprep.verify.unwritten import verify_result

    profile = check_job(job)
    carried = carries_blocker(job.output.suffix, job.written_for)
    options = replace(job.options, blocker=job.options.blocker and carried)
    result = hollow_with(job.model, profile, job.placement, options, progress)
    file_findings = [
        *format_findings(
            result.profile, job.output, job.written_for, infill=result.infill is not None
        ),
        *colour_findings(result.paint, job.output, job.written_for),
    ]
    if result.supports is not None:
        file_findings += vault_findings(
            result.supports.rule,
            job.output.suffix,
            job.written_for,
            chosen=job.options.vaults is not None,
        )
    if job.plugs is not None:
        file_findings += _plug_findings(result.drainage, job.plugs)
    result = replace(result, findings=sorted_findings([*result.findings, *file_findings]))
    if job.simulate:
        with progress.stage("simulate"):
            result = _simulated(result)
    compared = job.model if job.report is not None and _is_mesh(job.model) else None
    verified = (
        verify_result(result, compare_with=compared, progress=progress) if job.verify else None
    )
    # A print depends on the slicer: its findings are reported, but not written into the part.
    print_findings = () if verified is None else verified.findings
    findings = sorted_findings([*result.findings, *print_findings])
    if job.fail_on is not None and at_or_above(findings, job.fail_on):
        return JobResult(result, findings, verified, None, None)
    with progress.stage("write"):
        plugs = _write(job, result)
    return JobResult(result, findings, verified, job.output, plugs)


def vaults_of(job: Job, profile: Profile) -> VaultChoice:
    """The vaults that a job builds: for the slicer where its file carries no support blocker."""
    from printprep.output.limits import carries_blocker
    from printprep.supports.policy import vault_choice

    carried = carries_blocker(job.output.suffix, job.written_for)
    return vault_choice(job.options.vaults, profile, blocker=job.options.blocker and carried)


def check_job(job: Job) -> Profile:
    """Check before the long work that a job can be done; return its profile.

    Raises UsageError, OutputError or ToolError, as ``run_job`` would later.
    """
    from printprep.output.limits import check_output

    check_output(job.output)
    if job.output.exists() and job.model.exists() and job.output.samefile(job.model):
        raise UsageError(
            f"{job.output} is the model, which would be replaced.",
            "Name another file with --output.",
        )
    profile = check_settings(job)
    _check_plugs(job)
    _check_report(job)
    return profile


def check_settings(job: Job) -> Profile:
    """Check that a job's options go together, whatever its files; return its profile.

    Raises UsageError, or ToolError where a slicer is needed and missing.
    """
    from printprep.output.manual_settings import check_slicer
    from printprep.pipeline.hollow import check_options
    from printprep.profiles import load_profile
    from printprep.verify.unwritten import check_verifiable

    profile = load_profile(job.profile, job.overrides)
    check_slicer(profile, job.written_for)
    _check_drains(job, profile)
    fill = fill_of(job.options.fill)
    fill.check_output(job.output.suffix, job.written_for)
    if job.simulate and not fill.solid:
        raise UsageError(
            "A print with infill cannot be simulated: the simulation takes the mesh for solid.",
            "Leave out --simulate, or use --verify, which measures the tilt angle in the G-code.",
        )
    check_options(profile, job.options)
    if job.verify:
        check_verifiable(job.output, profile)
    return profile


def _check_drains(job: Job, profile: Profile) -> None:
    if not profile.drain.count and (job.plugs is not None or "drain.diameter_mm" in job.overrides):
        what = "--plugs has" if job.plugs is not None else "A drain diameter has"
        raise UsageError(
            f"{what} no effect: profile {profile.name} makes no drain holes.",
            "Request drain holes with --drains N and --drain-diameter MM, or choose a profile for "
            "resin or powder.",
        )


def _check_plugs(job: Job) -> None:
    from printprep.output.limits import check_output

    if job.plugs is None:
        return
    if job.plugs.suffix.lower() != ".3mf":
        raise UsageError(
            f"{job.plugs}: --plugs writes only .3mf.", "Name a file that ends in .3mf."
        )
    check_output(job.plugs)
    for file, noun in ((job.output, "part"), (job.model, "model")):
        if job.plugs.resolve() == file.resolve():
            raise UsageError(
                f"{job.plugs} is the {noun}, which would be replaced.",
                "Name another file with --plugs.",
            )


def _check_report(job: Job) -> None:
    from printprep.output.limits import check_page

    if job.report is None:
        return
    check_page(job.report, "report")
    for file, noun in ((job.output, "part"), (job.model, "model"), (job.plugs, "file of plugs")):
        if file is not None and job.report.resolve() == file.resolve():
            raise UsageError(
                f"{job.report} is the {noun}, which would be replaced.",
                "Name another file with --report.",
            )


def _is_mesh(model: Path) -> bool:
    from printprep.generators.read import SUFFIXES

    return model.suffix.lower() not in SUFFIXES


def _plug_findings(drainage: Drainage | None, plugs: Path) -> tuple[Finding, ...]:
    """That the file of plugs is not written, if there is nothing to plug."""
    from printprep.check.catalogue import finding

    if drainage is not None and drainage.drains:
        return ()
    return (finding("no-plugs", f"{plugs} was not written: the part has no drain holes."),)


def _simulated(result: HollowResult) -> HollowResult:
    from printprep.check import sorted_findings
    from printprep.check.simulated import disagreements
    from printprep.stand.trial import trial

    simulation = trial(result.part.manifold, result.profile.printer.first_layer_mm, result.lean)
    findings = sorted_findings([*result.findings, *disagreements(simulation)])
    return replace(result, simulation=simulation, findings=findings)


def _write(job: Job, result: HollowResult) -> Path | None:
    """Write the part and its plugs; return the file of the plugs, None if there are none."""
    from printprep.output.plugs import write_plugs

    result.write(job.output, job.written_for, without_blocker=True)
    if job.plugs is None or result.drainage is None or not result.drainage.drains:
        return None
    write_plugs(result.part, result.drainage, result.profile, job.plugs)
    return job.plugs
