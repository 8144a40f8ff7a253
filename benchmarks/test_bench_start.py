"""How long it takes to begin: importing the package (< 0.1 s) and --help's own work (< 0.3 s).

Each round is a new interpreter; what the bare interpreter takes is measured beside, to subtract.
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
