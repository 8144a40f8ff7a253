"""The user's own profiles: made, found by name, and never in the way of those that come along."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from printprep.cli.run import run
from printprep.errors import UsageError
from printprep.profile_folders import find_profile, profile_names, user_profile_path
from printprep.profiles import load_profile, user_profile_names


@pytest.fixture
def own(tmp_path, monkeypatch) -> Path:
    """The folder of the user's own profiles, which is not there yet."""
    folder = tmp_path / "settings" / "profiles"
    monkeypatch.setenv("PRINTPREP_PROFILES", str(folder))
    return folder


@pytest.mark.parametrize("base", profile_names())
def test_a_new_profile_is_its_base_under_another_name(own, base, capsys):
    assert run(["profiles", "new", "mine", "--from", base]) == 0
    assert str(own / "mine.toml") in capsys.readouterr().out
    made = load_profile("mine")
    assert made.name == "mine"
    assert made.model_dump() == {**load_profile(base).model_dump(), "name": "mine"}
    text = (own / "mine.toml").read_text(encoding="utf-8")
    assert text.startswith(f"# Profile mine: a copy of {base}")
    assert text.count("#") > 10


def test_every_profile_option_takes_it(own, tmp_path, capsys):
    assert run(["profiles", "new", "mine"]) == 0
    path = own / "mine.toml"
    path.write_text(path.read_text(encoding="utf-8").replace("wall_mm = 1.2 ", "wall_mm = 2.4 "))
    capsys.readouterr()
    assert run(["profiles", "show", "mine", "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["wall_mm"] == 2.4
    assert run(["profiles", "export", "mine"]) == 0
    assert "perimeters = 3\n" in capsys.readouterr().out
    assert run(["profiles", "new", "second", "--from", "mine"]) == 0
    assert load_profile("second").wall_mm == 2.4


def test_the_list_tells_them_apart(own, capsys):
    run(["profiles", "new", "mine", "--from", "sls-pa12"])
    (own / "broken.toml").write_text("wall_mm = 'thick'\n", encoding="utf-8")
    capsys.readouterr()
    assert run(["profiles"]) == 0
    shipped, _, yours = capsys.readouterr().out.partition(f"Your own, in {own}:")
    assert [line.split()[0] for line in shipped.splitlines()[1:-1]] == list(profile_names())
    assert "mine" in yours.split()
    assert "broken is not usable." in yours
    assert run(["profiles", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [item["name"] for item in data["profiles"]] == [*profile_names(), "mine"]
    assert data["own"]["folder"] == str(own)
    assert data["own"]["names"] == ["mine"]
    assert [item["name"] for item in data["own"]["refused"]] == ["broken"]


def test_one_that_is_there_is_replaced_only_by_force(own, capsys):
    assert run(["profiles", "new", "mine"]) == 0
    before = (own / "mine.toml").read_bytes()
    assert run(["profiles", "new", "mine", "--from", "sls-pa12"]) == 2
    assert "--force" in capsys.readouterr().err
    assert (own / "mine.toml").read_bytes() == before
    assert run(["profiles", "new", "mine", "--from", "sls-pa12", "--force"]) == 0
    assert load_profile("mine").process == "powder"


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", ".mine", "mine.", "a/b", "a\\b", "../up", "con", "NUL.x", "com1", "mine.toml",
     "fdm-pla-0.4", "FDM-PLA-0.4", "two words", "x" * 65, "a\nb", "a\0b", "-p"],
)  # fmt: skip
def test_a_name_that_cannot_be_one_writes_nothing(own, name, capsys):
    assert run(["profiles", "new", "--", name]) == 2
    assert capsys.readouterr().err.startswith("printprep: error: ")
    assert not own.exists()


@given(st.text(max_size=70))
def test_any_name_is_a_file_in_the_folder_or_refused(name):
    try:
        path = user_profile_path(name)
    except UsageError as error:
        assert error.hint
    else:
        folder = Path(os.environ["PRINTPREP_PROFILES"])
        assert path.parent == folder
        assert path.stem == name
        assert path.resolve().parent == folder.resolve()


def test_a_name_that_differs_in_case_alone_is_refused(own, capsys):
    assert run(["profiles", "new", "Mine"]) == 0
    assert run(["profiles", "new", "mine", "--force"]) == 2
    assert "only in case" in capsys.readouterr().err
    assert user_profile_names() == ("Mine",)


def test_a_base_that_is_no_profile_writes_nothing(own, tmp_path, capsys):
    assert run(["profiles", "new", "mine", "--from", "fdm-pla"]) == 2
    assert "Did you mean fdm-pla-0." in capsys.readouterr().err
    bad = tmp_path / "bad.toml"
    bad.write_text("process = 'fdm'\n", encoding="utf-8")
    assert run(["profiles", "new", "mine", "--from", str(bad)]) == 2
    assert not own.exists()


def test_a_folder_that_cannot_be_made_is_an_output_error(tmp_path, monkeypatch, capsys):
    (tmp_path / "file").write_text("x")
    monkeypatch.setenv("PRINTPREP_PROFILES", str(tmp_path / "file" / "profiles"))
    assert run(["profiles", "new", "mine"]) == 5
    assert "PRINTPREP_PROFILES" in capsys.readouterr().err


def test_one_that_hides_behind_a_shipped_name_is_told(own):
    own.mkdir(parents=True)
    (own / "sls-pa12.toml").write_text("", encoding="utf-8")
    with pytest.raises(UsageError, match="two profiles named sls-pa12"):
        find_profile("sls-pa12")
    assert find_profile("fdm-pla-0.4").stem == "fdm-pla-0.4"


def test_their_errors_name_the_file_and_their_names_are_suggested(own):
    own.mkdir(parents=True)
    (own / "workshop.toml").write_text("wall_mm = -1\n", encoding="utf-8")
    with pytest.raises(UsageError, match=r"Profile workshop \(.*workshop\.toml\)"):
        load_profile("workshop")
    with pytest.raises(UsageError) as caught:
        load_profile("workshpo")
    assert caught.value.hint == "Did you mean workshop?"


@pytest.mark.skipif(sys.platform != "linux", reason="each system has a folder of its own")
def test_without_the_variable_they_are_in_the_users_configuration(tmp_path):
    environment = {key: value for key, value in os.environ.items() if key != "PRINTPREP_PROFILES"}
    environment["XDG_CONFIG_HOME"] = str(tmp_path)
    subprocess.run(
        [sys.executable, "-m", "printprep", "profiles", "new", "mine"],
        check=True, capture_output=True, env=environment,
    )  # fmt: skip
    text = (tmp_path / "printprep" / "profiles" / "mine.toml").read_text(encoding="utf-8")
    assert tomllib.loads(text)["process"] == "fdm"
