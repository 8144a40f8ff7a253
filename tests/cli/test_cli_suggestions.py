"""A name that is mistyped is met with the one that was probably meant."""

from __future__ import annotations

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

from printprep.cli.app import printprep
from printprep.cli.run import run
from printprep.profile_folders import profile_names
from printprep.profiles import load_profile
from printprep.wording import nearest


@pytest.mark.parametrize(
    ("line", "message", "hint"),
    [
        ("holow x.stl", "no command holow.", "Did you mean hollow? `printprep --help`"),
        ("Check x.stl", "no command Check.", "Did you mean check? `printprep --help`"),
        ("profiles shw x", "no command shw.", "Did you mean show? `printprep profiles --help`"),
        ("x.stl", "no command x.stl.", "`printprep hollow x.stl` hollows a model. `printprep"),
        ("qqq", "no command qqq.", "`printprep --help`"),
        ("hollow x --profle y", "no option --profle.", "Did you mean --profile? `printprep hollow"),
        ("hollow x --lan 3", "no option --lan.", "Did you mean --lean? `printprep hollow --help`"),
        ("hollow x --zzz", "no option --zzz.", "`printprep hollow --help`"),
        ("hollow x -Z", "no option -Z.", "`printprep hollow --help` shows the usage."),
        ("profiles show PLA", "no profile named PLA.", "Did you mean fdm-pla-0.4?"),
        ("hollow x -p resin", "no profile named resin.", "Did you mean resin-msla-mono?"),
    ],
)  # fmt: skip
def test_the_nearest_is_named(capsys, line, message, hint):
    assert run(line.split()) == 2
    said, helped = capsys.readouterr().err.splitlines()
    assert said == f"printprep: error: There is {message}"
    assert helped.strip().startswith(hint)


@pytest.mark.parametrize(
    ("key", "meant"),
    [
        ("layer_height_mm", "printer.layer_height_mm"),
        ("printer.lean_deg", "stability.lean_deg"),
        ("printer.layer_heigth_mm", "printer.layer_height_mm"),
        ("wall", "wall_mm"),
        ("prnter.nozzle_mm", "printer"),
        ("slicer.object_setings.perimeters", "slicer.object_settings"),
        ("density", "infill.density"),
        ("infill.densty", "infill.density"),
        ("overhang.shr", "overhang.share"),
    ],
)
def test_the_nearest_key_of_a_profile_is_named(capsys, key, meant):
    assert run(["profiles", "export", "fdm-pla-0.4", "--set", f"{key}=1"]) == 2
    assert f"is unknown; did you mean {meant}?\n" in capsys.readouterr().err


def test_a_key_that_is_near_to_none_gets_the_list(capsys):
    assert run(["profiles", "export", "fdm-pla-0.4", "--set", "printer.qqq=1"]) == 2
    assert (
        "printer.qqq is unknown; allowed here: nozzle_mm, line_width_mm" in capsys.readouterr().err
    )


def _keys(data: dict, above: str = "") -> list[str]:
    found = []
    for key, value in data.items():
        found.append(above + key)
        if isinstance(value, dict) and key != "object_settings":
            found += _keys(value, f"{above}{key}.")
    return found


KEYS = [key for key in _keys(load_profile().model_dump()) if key != "name"]


@given(st.data())
def test_one_letter_too_few_is_understood(data):
    """For every command, profile and key with four letters or more."""
    commands = printprep.list_commands(click.Context(printprep))
    known = data.draw(st.sampled_from([commands, list(profile_names()), KEYS]))
    name = data.draw(st.sampled_from([name for name in known if len(name) > 3]))
    cut = data.draw(st.integers(0, len(name) - 1))
    typed = name[:cut] + name[cut + 1 :]
    found = nearest(typed, known)
    assert found is not None
    # Another name may be as near: fdm-pla-0. is as near to fdm-pla-0.4 as to fdm-pla-0.6
    assert typed in known or abs(len(found) - len(name)) <= 1


@given(st.text(max_size=300), st.lists(st.text(max_size=20)))
def test_what_is_suggested_is_known(word, known):
    assert nearest(word, known) in (*known, None)


@given(st.text(), st.lists(st.text()))
def test_what_is_known_is_its_own_nearest(word, known):
    assert nearest(word, [*known, word]).casefold() == word.casefold()
