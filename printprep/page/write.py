"""The page about a job's part, as the command and a batch write it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from printprep.page.build import page_of_result, source_of
from printprep.page.document import write_page

if TYPE_CHECKING:
    from printprep.pipeline.job import Job, JobResult


def write_report(done: JobResult, job: Job, command: str | None = None) -> None:
    """Write the page that a job asks for, whether its part was written or stopped by a finding.

    command : the command line to repeat.

    Raises OutputError if the file cannot be written, ValueError for a job without a report.
    """
    if job.report is None:
        raise ValueError(f"the job of {job.model} asks for no page")
    page = page_of_result(
        done.result, done.findings, source_of(job.model, command), verified=done.verified
    )
    write_page(page, job.report)
