"""docs/troubleshooting.md says cause and cure of every finding, and nothing that is not so."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest
from click import Command, Context, Group
from command_lines import missing_targets

from printprep.check.catalogue import CATALOGUE
from printprep.check.troubleshooting import REMEDIES, TOPICS
from printprep.cli.app import printprep
from printprep.profiles import load_profile

DOCS = Path(__file__).resolve().parent.parent.parent / "docs"


def options(command: Command) -> set[str]:
    """Every long option of a command and of those below it."""
    found = {name for item in command.params for name in item.opts if name.startswith("--")}
    if isinstance(command, Group):
        context = Context(command)
        for name in command.list_commands(context):
            below = command.get_command(context, name)
            assert below is not None
            found |= options(below)
    return found


def test_the_page_is_up_to_date():
    made = runpy.run_path(str(DOCS / "make_troubleshooting.py"))["reference"]()
    page = (DOCS / "troubleshooting.md").read_text(encoding="utf-8")
    assert page == made, "run: python3 dev.py docs"


def test_every_finding_has_one_row():
    rows = [remedy.id for topic in TOPICS for remedy in topic.remedies]
    assert sorted(rows) == sorted(CATALOGUE)


@pytest.mark.parametrize("remedy", REMEDIES.values(), ids=lambda remedy: remedy.id)
def test_cause_and_cure_are_sentences_of_one_paragraph(remedy):
    for text in (remedy.cause, remedy.cure):
        assert re.fullmatch(r"[A-Z`].{20,}[.]", text), text
        assert "\n" not in text


@pytest.mark.parametrize("remedy", REMEDIES.values(), ids=lambda remedy: remedy.id)
def test_they_name_options_keys_and_commands_that_there_are(remedy):
    text = f"{remedy.cause} {remedy.cure}"
    assert set(re.findall(r"--[a-z-]+", text)) <= options(printprep)
    commands = set(re.findall(r"`printprep (\w+)", text))
    assert commands <= set(printprep.list_commands(Context(printprep)))
    for key in re.findall(r"--set ([\w.]+)=", text):
        value: object = load_profile("resin-standard")
        for name in key.split("."):
            assert hasattr(value, name), f"no profile key {key}"
            value = getattr(value, name)


def test_pages_that_are_linked_exist():
    page = (DOCS / "troubleshooting.md").read_text(encoding="utf-8")
    headings = set(re.findall(r"^### (.+)$", page, re.M))
    assert set(re.findall(r"\]\(#([^)]+)\)", page)) == headings == set(CATALOGUE)
    assert missing_targets(DOCS / "troubleshooting.md") == []
