"""One job in an interpreter of its own, which is ended with all it started when its time is up.

``python -m printprep.batches.apart`` is that interpreter: a pickled job comes in, what came of it
goes out.  A Dask worker runs jobs with a time limit so: it cannot end its own work, and may not
have children of multiprocessing.
"""

from __future__ import annotations

import contextlib
import os
import pickle
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

from printprep.batches.local import crash_facts, timeout_facts
from printprep.batches.row import Told

if TYPE_CHECKING:
    from printprep.pipeline.job import Job


def run_apart(job: Job, timeout_s: float) -> Told:
    """What comes of a job within its time; its process is gone afterwards."""
    posix = os.name == "posix"
    child = subprocess.Popen(
        [sys.executable, "-m", "printprep.batches.apart"],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=posix,
    )
    try:
        out, _ = child.communicate(pickle.dumps(job), timeout=timeout_s)
    except subprocess.TimeoutExpired:
        return Told("timeout", timeout_facts(timeout_s))
    finally:
        # A slicer or a repair that the job started goes with it
        if posix:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child.pid, signal.SIGKILL)
        child.kill()
        child.communicate()
    if child.returncode != 0:
        return Told("crashed", crash_facts(child.returncode))
    told: Told = pickle.loads(out)  # written by our own child, over a pipe of our own
    return told


def main() -> None:
    """Read a job from standard input, run it, and write what came of it."""
    from printprep.batches.work import run_one

    out = sys.stdout.buffer
    sys.stdout = sys.stderr
    out.write(pickle.dumps(run_one(pickle.loads(sys.stdin.buffer.read()))))
    out.flush()


if __name__ == "__main__":
    main()
