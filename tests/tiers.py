"""The tiers of the tests: which of them run, in which order, and how long an unmarked one may take.

An unmarked test is of the fast tier, which runs by default. pyproject.toml says what each of the
others holds. ``--all`` runs every tier, ``-m slicer`` one, a test's own name that test.
"""

from __future__ import annotations

import os
import time
from collections.abc import Generator

import pytest

TIERS = ("slow", "slicer", "corpus", "browser")
# An unmarked test that takes longer is listed at the end of a run.
LIMIT_S = 3.0
TAKEN = "seconds of an unmarked test"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--all", dest="every_tier", action="store_true", help="run the tests of every tier"
    )


def pytest_configure(config: pytest.Config) -> None:
    """Choose the fast tier where the command line chooses nothing else."""
    named = any("::" in argument for argument in config.args)
    if not (config.option.every_tier or config.option.markexpr or named):
        config.option.markexpr = f"not ({' or '.join(TIERS)})"


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """In parallel, begin with the longest tests, so that no worker is left with one at the end.

    They are those of more tiers than one: real models through the real slicer.
    """
    if hasattr(config, "workerinput"):
        items.sort(key=lambda item: -len(tiers_of(item)))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call(item: pytest.Item) -> Generator[None, object, object]:
    """Note how long an unmarked test takes, for the list at the end.

    Counted is its processor time, its child processes' too: on a machine that is busy with
    something else, time on the clock grows and processor time hardly does. Threads that run side
    by side, or wait for each other in a loop, spend more of it than the clock shows, so that the
    lesser of the two counts.
    """
    clock_s, processor_s = time.perf_counter(), spent_s()
    result = yield
    taken_s = min(time.perf_counter() - clock_s, spent_s() - processor_s)
    if not tiers_of(item) and taken_s > LIMIT_S:
        item.user_properties.append((TAKEN, round(taken_s, 1)))
    return result


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """List the unmarked tests above the limit. Time alone fails none: machines differ."""
    taken = {
        report.nodeid: value
        for report in terminalreporter.stats.get("passed", [])
        for name, value in report.user_properties
        if name == TAKEN
    }
    if taken:
        terminalreporter.section(f"unmarked tests of more than {LIMIT_S:g} s")
        for test, value in sorted(taken.items(), key=lambda row: -row[1]):
            terminalreporter.write_line(f"{value:6.1f} s  {test}")
        terminalreporter.write_line(
            "Make them faster, or mark them slow and keep a faster case of what each covers."
        )


def tiers_of(item: pytest.Item) -> list[str]:
    """The tiers that a test is marked with."""
    return [tier for tier in TIERS if item.get_closest_marker(tier) is not None]


def spent_s() -> float:
    """Seconds of processor time of this process, and of its children that have ended."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system
