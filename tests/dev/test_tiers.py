"""Which tests run when, and that slow unmarked ones are listed and fail for nothing."""

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
import tiers

tiers.LIMIT_S = 0.1

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
    """Run tests of each kind with a command line: what became of those that ran, and the output."""
    (tmp_path / "test_kinds.py").write_text(TESTS)
    markers = "\n  ".join(tiers.TIERS)
    (tmp_path / "pytest.ini").write_text(f"[pytest]\nmarkers =\n  {markers}\n")

    def run(*options: str) -> tuple[dict[str, str], str]:
        environment = {**os.environ, "PYTHONPATH": str(Path(tiers.__file__).parent)}
        environment |= {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
        done = subprocess.run(
            [sys.executable, "-m", "pytest", "-v", "-p", "tiers", *options],
            capture_output=True, encoding="utf-8", check=False, cwd=tmp_path, env=environment,
        )  # fmt: skip
        lines = [line.split()[:2] for line in done.stdout.splitlines() if "::test_" in line]
        found = {
            name.split("::test_")[1]: what.lower()
            for name, what in lines
            if what in ("PASSED", "FAILED")
        }
        return found, done.stdout

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
    found, _ = outcomes(*options)
    assert found == dict.fromkeys(names, "passed")


def test_an_unmarked_test_that_computes_for_long_is_listed_and_no_other(outcomes):
    found, printed = outcomes("--all")
    assert set(found.values()) == {"passed"}
    listed = printed.partition("unmarked tests of more than 0.1 s")[2]
    assert "::test_long" in listed
    assert not [name for name in ("fast", "waits", "slow", "real") if f"::test_{name}" in listed]
