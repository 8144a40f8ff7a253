"""Stages on stderr for a person who watches, and for nobody else."""

from __future__ import annotations

import io
import sys
import threading
import time

import pytest

from printprep.progress import SILENT, STAGES, Silent, Spinner, for_terminal


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_silence_is_silent(capsys):
    with SILENT.stage("solve"):
        pass
    assert capsys.readouterr() == ("", "")


def test_a_spinner_only_where_a_person_watches(monkeypatch):
    monkeypatch.setattr(sys, "stderr", io.StringIO())
    assert isinstance(for_terminal(), Silent)
    monkeypatch.setattr(sys, "stderr", Terminal())
    assert isinstance(for_terminal(quiet=True), Silent)
    assert isinstance(for_terminal(), Spinner)


@pytest.mark.parametrize("name", STAGES)
def test_each_stage_has_words_that_go_to_stderr(monkeypatch, name):
    screen, out = Terminal(), Terminal()
    monkeypatch.setattr(sys, "stderr", screen)
    monkeypatch.setattr(sys, "stdout", out)
    monkeypatch.setenv("TERM", "xterm")
    with Spinner(after_s=0).stage(name):
        pass
    assert STAGES[name] in screen.getvalue()
    assert out.getvalue() == ""


def test_an_error_in_a_stage_comes_through():
    with pytest.raises(ZeroDivisionError), SILENT.stage("solve"):
        raise ZeroDivisionError


def watched(monkeypatch: pytest.MonkeyPatch) -> Terminal:
    """A terminal in the place of stderr.  Not a fixture: as a test begins, pytest puts its own."""
    shown = Terminal()
    monkeypatch.setattr(sys, "stderr", shown)
    monkeypatch.setenv("TERM", "xterm")
    return shown


def test_what_is_done_at_once_says_nothing(monkeypatch):
    screen = watched(monkeypatch)
    spinner = Spinner()
    for name in STAGES:
        with spinner.stage(name):
            pass
    assert screen.getvalue() == ""


def test_the_stage_that_is_at_work_when_the_run_gets_long_is_named(monkeypatch):
    screen = watched(monkeypatch)
    spinner = Spinner(after_s=0.05)
    with spinner.stage("read"):
        pass
    with spinner.stage("repair"):
        until = time.monotonic() + 10
        while STAGES["repair"] not in screen.getvalue() and time.monotonic() < until:
            time.sleep(0.01)
    with spinner.stage("solve"):  # the run is long by now: it is named at once
        pass
    shown = screen.getvalue()
    assert STAGES["read"] not in shown
    assert shown.index(STAGES["repair"]) < shown.index(STAGES["solve"])
    assert shown.endswith("\x1b[2K")  # the line is gone


def test_an_error_in_a_waiting_stage_comes_through_and_leaves_no_line(monkeypatch):
    screen = watched(monkeypatch)
    threads = threading.active_count()
    with pytest.raises(ZeroDivisionError), Spinner().stage("solve"):
        raise ZeroDivisionError
    assert screen.getvalue() == ""
    assert threading.active_count() <= threads  # one that another test began may end meanwhile
