"""One model in a worker: run its job, measure it, and tell what came of it whatever happens."""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from printprep.batches.item import key_of, sha256_of
from printprep.batches.row import Told, failed_by, told_by
from printprep.errors import PrintprepError

if TYPE_CHECKING:
    from printprep.pipeline.job import Job

DEFECT_HINT = "Run this model alone with `printprep hollow -v`, and report the traceback."


def run_one(job: Job) -> Told:
    """Run a job whose files this process reaches; never raises but for what ends the process."""
    _forget_peak()
    start = time.perf_counter()
    key = key_of(job)  # of the file as it is now
    told = _run(job)
    facts = {
        **told.facts,
        "key": key,
        "seconds": round(time.perf_counter() - start, 3),
        "peak_mib": peak_mib(),
    }
    return replace(told, facts=facts)


def run_sent(job: Job, content: bytes, run: Callable[[Job], Told] = run_one) -> Told:
    """Run a job whose model was sent, in a folder of its own; the part comes back as bytes.

    run : what does the job.
    """
    with tempfile.TemporaryDirectory(prefix="printprep-") as name:
        model, output = Path(name) / job.model.name, Path(name) / "out" / job.output.name
        output.parent.mkdir()
        model.write_bytes(content)
        told = run(replace(job, model=model, output=output))
        part = output.read_bytes() if told.status == "part" else None
        return replace(told, output=part, facts=_named(told.facts, model, job.model))


def _named(facts: Mapping[str, Any], sent: Path, model: Path) -> dict[str, Any]:
    """Facts that name the model where its owner has it, not where it was sent to."""
    return {
        key: value.replace(str(sent), str(model)) if isinstance(value, str) else value
        for key, value in facts.items()
    }


def _run(job: Job) -> Told:
    from printprep.page.write import write_report
    from printprep.pipeline.job import run_job

    try:
        job.output.parent.mkdir(parents=True, exist_ok=True)
        done = run_job(job)
        if job.report is not None:
            write_report(done, job)
        if done.stopped:
            return Told("stopped", told_by(done, None))
        return Told("part", told_by(done, sha256_of(job.output)))
    except PrintprepError as error:
        return Told("error", failed_by(error))
    except MemoryError:
        return Told("memory", {"code": "memory", "message": "There was not enough memory."})
    except OSError as error:
        return Told("error", {"code": "output", "message": str(error), "hint": None})
    except Exception as error:  # a defect is one model's row, not the batch's end
        what = f"{type(error).__name__}: {error}" if str(error) else type(error).__name__
        message = f"This is a defect of printprep: {' '.join(what.split())}"
        return Told("error", {"code": "defect", "message": message, "hint": DEFECT_HINT})


def _forget_peak() -> None:
    """Start the system's own peak of this process anew, where it can be (Linux)."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return


def peak_mib() -> float | None:
    """Largest resident memory of this process, MiB; since the last job's start on Linux."""
    try:
        lines = Path("/proc/self/status").read_text(encoding="ascii", errors="replace").splitlines()
        (peak,) = (line.split()[1] for line in lines if line.startswith("VmHWM:"))
        return round(int(peak) / 1024, 1)
    except (OSError, ValueError):
        return _lifetime_peak_mib()


def _lifetime_peak_mib() -> float | None:
    if sys.platform == "win32":
        return None
    import resource

    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return round(peak / (1 << 20 if sys.platform == "darwin" else 1024), 1)
