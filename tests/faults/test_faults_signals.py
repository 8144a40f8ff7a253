"""Signals at every stage: the output is the old or the new file, and nothing else is left."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from fault_runs import INTERRUPT, KILL, TERMINATE, clear, ended, names, started

from printprep.mesh.write import to_bytes

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="reads processes from /proc")

# A slicer that starts a process of its own, in another session, and waits for it.
HANGS = """#!/bin/bash
for a in "$@"; do [ "$a" = --help ] && { echo "PrusaSlicer-2.9.0 fake"; exit 0; }; done
touch "$STARTED"
setsid sleep 300 &
wait
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder for a run, with a model beside it."""
    from manifold3d import Manifold

    (tmp_path / "ball.stl").write_bytes(to_bytes(Manifold.sphere(12, 48), ".stl"))
    work = tmp_path / "work"
    work.mkdir()
    return work


def hollow(folder: Path, *more: str) -> list[str | Path]:
    return [
        "hollow",
        folder.parent / "ball.stl",
        "-o",
        folder / "out.3mf",
        "--resolution",
        "32",
        *more,
    ]


def disturbed(folder: Path, mark: str, after_s: float, number: int, *more: str):
    """A run that gets a signal after a time: its process, how long it lived on, its streams."""
    run = started(hollow(folder, *more), folder, mark)
    time.sleep(after_s)
    began = time.monotonic()
    run.send_signal(number)
    out, err = run.communicate(timeout=60)
    return run, time.monotonic() - began, out, err


@pytest.mark.parametrize("after_s", [0.2, 0.6, 1.2])
@pytest.mark.parametrize(("number", "code"), [(INTERRUPT, 130), (TERMINATE, 143)])
def test_a_signal_ends_a_run_at_once_with_its_code(
    folder: Path, after_s: float, number: int, code: int
):
    (folder / "out.3mf").write_bytes(b"old")
    run, lived_s, _, err = disturbed(folder, f"{number}-{after_s}", after_s, number)
    assert run.returncode == code
    assert lived_s < 1.5
    assert clear(err), err
    assert ended(f"{number}-{after_s}", 0.0)
    assert names(folder) == ["out.3mf"]
    assert (folder / "out.3mf").read_bytes() == b"old"


def test_an_interrupt_is_json_too(folder: Path):
    run, _, out, err = disturbed(folder, "json", 0.8, INTERRUPT, "--json")
    assert run.returncode == 130
    assert json.loads(out)["error"]["code"] == "interrupted"
    assert err == ""


@pytest.mark.slow
@pytest.mark.parametrize("number", [KILL, INTERRUPT, TERMINATE])
def test_at_every_moment_the_output_is_old_or_new_and_alone(folder: Path, number: int):
    """The moments are spread over a whole run, and lie close together where it writes."""
    began = time.monotonic()
    whole = started(hollow(folder), folder, "whole")
    whole.communicate(timeout=300)
    assert whole.returncode == 0
    lasts_s = time.monotonic() - began
    new = (folder / "out.3mf").read_bytes()
    moments = [lasts_s * k / 8 for k in range(1, 7)]
    moments += [lasts_s * (0.9 + 0.02 * k) for k in range(6)]
    for moment in moments:
        (folder / "out.3mf").write_bytes(b"old")
        mark = f"every-{number}-{moment}"
        run, lived_s, _, err = disturbed(folder, mark, moment, number)
        assert ended(mark, 5.0)
        assert names(folder) == ["out.3mf"], moment
        assert (folder / "out.3mf").read_bytes() in (b"old", new), moment
        assert "Traceback" not in err
        if number == INTERRUPT:
            assert run.returncode in (0, 130)
            assert lived_s < 1.5 or run.returncode == 0


@pytest.fixture
def slicing(folder: Path):
    """Start a run that waits for a slicer, and return it when the slicer is at work."""

    def start(mark: str) -> subprocess.Popen[str]:
        slicer = folder.parent / "slicer.sh"
        slicer.write_text(HANGS)
        slicer.chmod(0o755)
        begun = folder.parent / "begun"
        run = started(
            hollow(folder, "--fill", "infill", "--slicer", str(slicer)),
            folder, mark, STARTED=str(begun),
        )  # fmt: skip
        last = time.monotonic() + 60
        while not begun.exists():
            assert run.poll() is None and time.monotonic() < last, run.communicate()
            time.sleep(0.05)
        return run

    return start


@pytest.mark.slow
@pytest.mark.parametrize("number", [INTERRUPT, TERMINATE, signal.SIGHUP, KILL])
def test_a_slicer_at_work_ends_with_the_run(folder: Path, slicing, number: int):
    run = slicing(f"slicing-{number}")
    run.send_signal(number)
    began = time.monotonic()
    _, err = run.communicate(timeout=60)
    assert time.monotonic() - began < 1.5
    assert ended(f"slicing-{number}", 3.0)
    assert names(folder) == []
    assert run.returncode == (-9 if number == KILL else 128 + number)
    assert "Traceback" not in err


@pytest.mark.slow
def test_a_command_that_is_killed_is_told_and_leaves_nothing(folder: Path, slicing):
    """The process that works is killed, as the system does for memory; the one that waits tells."""
    run = slicing("killed")
    (worker,) = [
        int(pid) for pid in Path(f"/proc/{run.pid}/task/{run.pid}/children").read_text().split()
    ]
    os.kill(worker, signal.SIGKILL)
    _, err = run.communicate(timeout=60)
    assert run.returncode == 3
    assert clear(err) and "memory" in err
    assert ended("killed", 1.0)
    assert names(folder) == []


def supervised(body: str, first: str = "") -> list[str]:
    """A run of the program whose command is this code, after some code in both its processes."""
    code = f"""
import os, printprep.cli.run, printprep.cli.supervise
{first}
def main(arguments):
    {body}
printprep.cli.run.main = main
printprep.cli.supervise.supervised(["check", "x.stl"])
"""
    return [sys.executable, "-c", code]


@pytest.mark.parametrize(("number", "code"), [(INTERRUPT, 130), (TERMINATE, 143)])
def test_a_library_that_holds_the_interpreter_does_not_hold_up_the_end(
    tmp_path: Path, number: int, code: int
):
    begun = tmp_path / "begun"
    body = f"open({str(begun)!r}, 'w').close(); import ctypes; ctypes.PyDLL(None).sleep(60)"
    run = subprocess.Popen(supervised(body), stderr=subprocess.PIPE, encoding="utf-8")
    while not begun.exists():
        assert run.poll() is None
        time.sleep(0.02)
    time.sleep(0.2)
    began = time.monotonic()
    run.send_signal(number)
    _, err = run.communicate(timeout=30)
    assert time.monotonic() - began < 1.5
    assert run.returncode == code
    assert clear(err)


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("os.abort()", "crashed (SIGABRT)"),
        ("os.kill(os.getpid(), 11)", "crashed (SIGSEGV)"),
        ("os._exit(1)", "ended with code 1"),
    ],
)
def test_a_library_that_ends_the_run_is_told(body: str, words: str):
    run = subprocess.run(supervised(body), capture_output=True, encoding="utf-8", check=False)
    assert run.returncode == 70
    assert clear(run.stderr) and words in run.stderr


def test_what_was_ignored_stays_ignored():
    """A run under nohup lives on when its terminal is closed."""
    body = "import time; os.kill(os.getppid(), 1); time.sleep(0.5); raise SystemExit(0)"
    run = subprocess.run(["nohup", *supervised(body)], capture_output=True, check=False)
    assert run.returncode == 0


@pytest.mark.parametrize("number", [INTERRUPT, TERMINATE, signal.SIGHUP])
@pytest.mark.parametrize("call", ["waitid", "waitpid"])
def test_a_signal_after_the_end_of_the_command_finds_nobody(number: int, call: str):
    """It comes at the worst moments: when the command has ended, and when it has been reaped."""
    first = f"""
waits = os.{call}
def disturbed(*arguments):
    found = waits(*arguments)
    os.kill(os.getpid(), {int(number)})
    return found
os.{call} = disturbed
"""
    run = subprocess.run(
        supervised("raise SystemExit(4)", first), capture_output=True, encoding="utf-8", check=False
    )
    assert (run.returncode, run.stderr) == (4, "")


@pytest.mark.parametrize("number", [INTERRUPT, TERMINATE, signal.SIGHUP])
@pytest.mark.parametrize("ends", ["raise SystemExit(4)", "pass"])
def test_a_signal_while_the_interpreter_ends_changes_nothing(number: int, ends: str):
    body = f"import atexit; atexit.register(lambda: os.kill(os.getpid(), {int(number)})); {ends}"
    run = subprocess.run(supervised(body), capture_output=True, encoding="utf-8", check=False)
    assert (run.returncode, run.stderr) == (4 if "4" in ends else 0, "")
