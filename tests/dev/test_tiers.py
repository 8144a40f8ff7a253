"""Which tests run when, and that time decides where a limit is set and nowhere else."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
import tiers

TESTS = """
import time
import pytest

def busy():
    start = time.process_time()
    while time.process_time() - start < 0.3:
        pass

def test_fast(): pass
def test_long(): busy()
def test_waits(): time.sleep(0.3)
@pytest.mark.slow
def test_slow(): busy()
@pytest.mark.slicer
@pytest.mark.corpus
def test_real(): pass
"""


@pytest.fixture
def outcomes(tmp_path: Path):
    """Run tests of each kind with a command line; what became of those that ran, by name."""
    (tmp_path / "test_kinds.py").write_text(TESTS)
    markers = "\n  ".join(tiers.TIERS)
    (tmp_path / "pytest.ini").write_text(f"[pytest]\nmarkers =\n  {markers}\n")

    def run(*options: str, limit_s: str | None = None) -> dict[str, str]:
        environment = {name: value for name, value in os.environ.items() if name != tiers.LIMIT}
        environment |= {"PYTHONPATH": str(Path(tiers.__file__).parent)}
        environment |= {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        if limit_s is not None:
            environment[tiers.LIMIT] = limit_s
        done = subprocess.run(
            [sys.executable, "-m", "pytest", "-v", "-p", "tiers", *options],
            capture_output=True, text=True, check=False, cwd=tmp_path, env=environment,
        )  # fmt: skip
        lines = [line.split()[:2] for line in done.stdout.splitlines() if "::test_" in line]
        return {
            name.split("::test_")[1]: what.lower()
            for name, what in lines
            if what in ("PASSED", "FAILED")
        }

    return run


@pytest.mark.parametrize(
    ("options", "names"),
    [
        ([], {"fast", "long", "waits"}),
        (["--all"], {"fast", "long", "waits", "slow", "real"}),
        (["-m", "slow or corpus"], {"slow", "real"}),
        (["test_kinds.py::test_slow"], {"slow"}),
    ],
)
def test_the_command_line_chooses_the_tiers(outcomes, options: list[str], names: set[str]):
    assert outcomes(*options) == dict.fromkeys(names, "passed")


def test_over_the_limit_an_unmarked_test_fails_that_computes_and_no_other(outcomes):
    found = outcomes("--all", limit_s="0.1")
    assert found.pop("long") == "failed"
    assert found == dict.fromkeys(("fast", "waits", "slow", "real"), "passed")
