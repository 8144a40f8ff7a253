"""What a worker may do to a batch, and models to do it to."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

from closed_form_parts import box

from printprep.batches.row import Told
from printprep.mesh.write import to_bytes
from printprep.pipeline.job import Job
from printprep.pipeline.options import FillOptions

QUICK = Job(Path(), Path(), options=FillOptions(resolution=16, vaults="none", blocker=False))


def models(folder: Path, *names: str, size: float = 20.0) -> list[Path]:
    """A cube of its own size for each name."""
    paths = []
    for number, name in enumerate(names):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(to_bytes(box(size + number), ".stl"))
        paths.append(path)
    return paths


def by_name(job: Job) -> Told:
    """Die, hang, run out of memory or be quick, as the model is called."""
    if job.model.stem == "dies":
        os.kill(os.getpid(), signal.SIGKILL)
    if job.model.stem == "hangs":
        time.sleep(600)
    if job.model.stem == "full":
        return Told("memory", {"code": "memory", "message": "There was not enough memory."})
    return Told("part", {"mass_g": 1.0})
