"""Stages on stderr for a person who watches, and for nobody else."""

from __future__ import annotations

import io
import sys

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
    with Spinner().stage(name):
        pass
    assert STAGES[name] in screen.getvalue()
    assert out.getvalue() == ""


def test_an_error_in_a_stage_comes_through():
    with pytest.raises(ZeroDivisionError), SILENT.stage("solve"):
        raise ZeroDivisionError
