"""Profiles from the JSON of OrcaSlicer and Bambu Studio."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from printprep.cli.run import run
from printprep.errors import PrintprepError
from printprep.profile_import.dialects import ORCA
from printprep.profile_import.orca_file import settings_of_json
from printprep.profiles import load_profile

PROCESS = {
    "type": "process",
    "name": "0.16mm mine",
    "inherits": "0.16mm Optimal @BBL X1C",
    "from": "User",
    "layer_height": "0.16",
    "initial_layer_print_height": "0.2",
    "line_width": "0.42",
    "outer_wall_line_width": "105%",
    "post_process": [],
    "version": "2.3.0.0",
}
FILAMENT = {
    "type": "filament",
    "name": "ASA mine",
    "from": "User",
    "filament_type": ["ASA"],
    "filament_density": ["1.07"],
    "filament_diameter": ["1.75"],
    "filament_flow_ratio": ["nil"],
}
MACHINE = {
    "type": "machine",
    "name": "X1C mine",
    "from": "User",
    "nozzle_diameter": ["0.4"],
    "printable_area": ["0x0", "256x0", "256x256", "0x256"],
    "printable_height": "250",
}


@pytest.fixture(autouse=True)
def own(tmp_path, monkeypatch) -> Path:
    folder = tmp_path / "own"
    monkeypatch.setenv("PRINTPREP_PROFILES", str(folder))
    return folder


@pytest.fixture
def files(tmp_path):
    """Writes presets, each into a file of its own; returns their names."""

    def write(*presets: object) -> list[str]:
        names = []
        for number, preset in enumerate(presets):
            path = tmp_path / f"{number}.json"
            text = preset if isinstance(preset, str) else json.dumps(preset)
            path.write_text(text, encoding="utf-8")
            names.append(str(path))
        return names

    return write


def test_process_filament_and_machine_make_one_profile(files, own, capsys):
    names = files(PROCESS, FILAMENT, MACHINE)
    assert run(["profiles", "import", *names, "mine", "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert {item["key"]: item["value"] for item in data["taken"]} == {
        "printer.nozzle_mm": 0.4,
        "printer.line_width_mm": 0.42,  # 105 % of the nozzle
        "printer.layer_height_mm": 0.16,
        "printer.first_layer_mm": 0.2,
        "printer.bed_mm": [256, 256, 250],
        "printer.filament_mm": 1.75,
        "material.name": "ASA",
        "material.density_g_cm3": 1.07,
    }
    assert data["missing"] == []
    assert data["absent"] == ["0.16mm Optimal @BBL X1C"]
    assert load_profile("mine").model_dump(mode="json") == data["profile"]
    assert 'name = "ASA" # filament_type in 1.json' in (own / "mine.toml").read_text()


def test_one_file_alone_says_what_it_lacks_and_where_that_may_be(files, capsys):
    assert run(["profiles", "import", *files(PROCESS), "mine"]) == 0
    out = " ".join(capsys.readouterr().out.split())
    assert "printer.nozzle_mm 0.4 nozzle_diameter is in none of the files" in out
    assert "0.45 outer_wall_line_width is 105% of what is in none of the files" in out
    assert "They build on 0.16mm Optimal @BBL X1C, which was not given" in out


def test_a_file_counts_over_the_one_that_it_inherits_from(files):
    above = {"name": "0.16mm Optimal @BBL X1C", "layer_height": "0.3", "inherits": "root"}
    root = {"name": "root", "layer_height": "0.1", "initial_layer_print_height": "0.25"}
    child = {key: value for key, value in PROCESS.items() if not key.startswith("initial")}
    root["inherits"] = ""
    for order in ((child, above, root), (root, above, child)):
        assert run(["profiles", "import", *files(*order), "mine", "--force"]) == 0
        printer = load_profile("mine").printer
        assert (printer.layer_height_mm, printer.first_layer_mm) == (0.16, 0.25)


def test_the_settings_of_a_whole_project(files):
    project = {**PROCESS, **FILAMENT, **MACHINE, "from": "project", "name": "project_settings"}
    assert run(["profiles", "import", *files(project), "mine"]) == 0
    assert load_profile("mine").material.name == "ASA"


def test_numbers_are_taken_as_texts_are(files):
    machine = {**MACHINE, "nozzle_diameter": [0.6], "printable_height": 250}
    process = {"layer_height": 0.3, "line_width": 0.65}
    assert run(["profiles", "import", *files(process, machine), "mine"]) == 0
    printer = load_profile("mine").printer
    assert (printer.nozzle_mm, printer.line_width_mm) == (0.6, 0.65)


@pytest.mark.parametrize(
    ("presets", "code", "fact"),
    [
        ([PROCESS, {"name": "b", "layer_height": "0.3"}], 2, "layer_height differs between"),
        ([PROCESS, PROCESS], 2, "the same name"),
        ([{"name": "a", "inherits": "a", "layer_height": "0.2"}], 3, "inherits from itself"),
        (
            [{"name": "a", "inherits": "b"}, {"name": "b", "inherits": "a"}, PROCESS],
            3,
            "inherits from itself",
        ),
        ([{"layer_height": {"a": 1}}], 3, "layer_height is not a text"),
        ([{"layer_height": True}], 3, "layer_height is not a text"),
        (['{"layer_height": NaN}'], 3, "layer_height is nan"),
        (["{"], 3, "not valid JSON"),
        (["[1, 2]"], 3, "none of the settings"),
        (['["a"]'], 3, "holds no settings"),
        (['{"a":' * 100_000], 3, "not valid JSON"),
        ([{"colour": "red"}], 3, "none of the settings"),
        ([PROCESS, "layer_height = 0.2\n"], 2, "different slicers"),
    ],
    ids=range(13),
)
def test_what_is_no_preset_is_told_and_nothing_is_written(files, own, capsys, presets, code, fact):
    assert run(["profiles", "import", *files(*presets), "mine"]) == code
    assert fact in capsys.readouterr().err
    assert not own.exists()


def test_json_has_no_sections(files, capsys):
    assert run(["profiles", "import", *files(PROCESS), "mine", "--section", "print:a"]) == 2
    assert "no sections" in capsys.readouterr().err


PLAIN = st.sampled_from(["", "a", "b", "0.2", "50%", "nil", "-1", 0.2, 1, None, True, {}])
VALUES = PLAIN | st.lists(PLAIN | st.just([1]), max_size=3)
KEYS = st.sampled_from(["name", "inherits", "inherits", *ORCA.names])


@given(st.lists(st.dictionaries(KEYS, VALUES, max_size=4), min_size=1, max_size=4))
def test_any_json_makes_settings_or_an_error(presets):
    texts = [(f"{number}.json", json.dumps(preset)) for number, preset in enumerate(presets)]
    try:
        settings = settings_of_json(texts)
    except PrintprepError as error:
        assert error.message.isprintable()
    else:
        assert {setting.file for setting in settings.values.values()} <= {f for f, _ in texts}
