"""Time the start: importing the package (< 0.1 s) and --help's own work (< 0.3 s).

Each round starts a new interpreter; the bare interpreter is timed too, to subtract.
Run:  pytest benchmarks/test_bench_start.py
"""

from __future__ import annotations

import subprocess
import sys

import pytest

STARTS = {
    "interpreter": ["-c", "pass"],
    "import": ["-c", "import printprep"],
    "help": ["-m", "printprep", "--help"],
}


@pytest.mark.parametrize("what", STARTS)
def test_start(benchmark, what):
    command = [sys.executable, *STARTS[what]]
    benchmark.pedantic(
        lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL),
        rounds=10,
        warmup_rounds=1,
    )
