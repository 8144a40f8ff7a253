"""Screens as golden files: at 60, 80 and 120 columns, in a pipe, in a terminal, without colour."""

from __future__ import annotations

import importlib.util
import io
import re
from pathlib import Path

import pytest
from rich.cells import cell_len

_SPEC = importlib.util.spec_from_file_location("screens", Path(__file__).with_name("screens.py"))
screens = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(screens)

GOLDEN = dict(screens.golden())
COLOUR = re.compile(r"\x1b\[[0-9;]*(?:3[0-8]|4[0-8]|9[0-7]|10[0-7])[0-9;]*m")
STYLE = re.compile(r"\x1b\[[0-9;]*m")


@pytest.mark.parametrize("path", GOLDEN, ids=lambda path: path.name)
def test_a_screen_is_its_golden_file(path):
    shown = path.read_text(encoding="utf-8")
    assert GOLDEN[path] == shown, "if this is meant: python3 tests/report/screens.py"


def test_there_are_no_other_golden_files():
    assert set(screens.FOLDER.iterdir()) == set(GOLDEN)


@pytest.mark.parametrize("name", screens.screens())
@pytest.mark.parametrize("width", range(60, 121, 5))
def test_no_line_is_wider_than_the_screen(name, width):
    """But for a line with a path, which is not broken so that it can be copied."""
    text = screens.screen(screens.screens()[name], width, io.StringIO())
    assert "…" not in text
    wide = [line for line in text.splitlines() if cell_len(line) > min(width, 100)]
    assert all(line.startswith(("Written:", "Your own, in")) for line in wide)


@pytest.mark.parametrize("name", screens.screens())
def test_a_pipe_gets_no_control_characters(name):
    text = screens.screen(screens.screens()[name], 80, io.StringIO())
    assert text.replace("\n", "").isprintable()


@pytest.mark.parametrize("name", screens.screens())
def test_no_color_takes_the_colour_and_leaves_the_words(name):
    draw = screens.screens()[name]
    terminal = screens.screen(draw, 80, screens.Terminal())
    without = screens.screen(draw, 80, screens.Terminal(), NO_COLOR="1")
    assert not COLOUR.search(without)
    assert STYLE.sub("", without) == STYLE.sub("", terminal)
    assert STYLE.sub("", terminal) == screens.screen(draw, 80, io.StringIO())


def test_a_terminal_has_colour_where_findings_are():
    terminal = screens.screen(screens.screens()["hollow"], 80, screens.Terminal())
    assert COLOUR.search(terminal)
    dumb = screens.screen(screens.screens()["hollow"], 80, screens.Terminal(), TERM="dumb")
    assert not COLOUR.search(dumb)
