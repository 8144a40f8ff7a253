"""README.md names commands, options and pages that there are."""

from __future__ import annotations

import re
import shlex
from pathlib import Path

import pytest
from command_lines import missing_targets, unknown_options

PAGE = Path(__file__).resolve().parent.parent / "README.md"
_COMMAND = re.compile(r"^(?:python3 dev\.py|(?:\.venv/bin/)?printprep) (?!test)(.+)$", re.M)


def commands() -> list[list[str]]:
    """The command lines of the page, each without the program's name and without its comment."""
    blocks = re.findall(r"^```(\w*)\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.S | re.M)
    lines = _COMMAND.findall("\n".join(text for language, text in blocks if not language))
    return [shlex.split(line, comments=True) for line in lines]


@pytest.mark.parametrize("words", commands(), ids=" ".join)
def test_every_command_can_be_parsed(words):
    assert unknown_options(words) == set()


def test_there_are_commands():
    assert len(commands()) >= 15


def test_pages_that_are_linked_exist():
    assert missing_targets(PAGE) == []
