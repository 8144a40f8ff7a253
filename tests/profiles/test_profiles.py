"""Profiles: the seven that come along, by name, by path, overridden, and refused."""

from __future__ import annotations

import subprocess
import sys
import time
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydantic import ValidationError

from printprep.errors import UsageError
from printprep.profiles import Profile, load_profile, profile_names, profile_source

NAMES = (
    "fdm-pla-0.4",
    "fdm-petg-0.4",
    "fdm-pla-0.6",
    "mjf-pa12",
    "resin-msla-mono",
    "resin-standard",
    "sls-pa12",
)


def test_the_seven_profiles_are_there_and_the_default_is_first() -> None:
    assert set(NAMES) <= set(profile_names())
    assert profile_names()[0] == "fdm-pla-0.4"
    assert load_profile().name == "fdm-pla-0.4"


@pytest.mark.parametrize("name", NAMES)
def test_every_profile_loads_and_can_be_built(name: str) -> None:
    profile = load_profile(name)
    assert profile.name == name
    assert profile.process == {"f": "fdm", "r": "resin", "s": "powder", "m": "powder"}[name[0]]
    assert profile.printer.first_layer_mm <= profile.wall_mm
    # a drain no wider than the wall is thick would be a tube, not a hole
    assert (profile.drain.count == 0) == (profile.process == "fdm")
    if profile.drain.count:
        assert profile.drain.diameter_mm is not None
        assert profile.drain.diameter_mm >= profile.wall_mm
    assert "post_process" not in profile.slicer.object_settings


def test_the_default_is_what_the_documents_promise() -> None:
    profile = load_profile()
    assert (profile.wall_mm, profile.min_feature_mm) == (1.2, 1.2)
    assert profile.printer.nozzle_mm == 0.4
    assert profile.printer.line_width_mm == 0.45
    assert (profile.printer.layer_height_mm, profile.printer.first_layer_mm) == (0.2, 0.2)
    assert profile.printer.bed_mm == (250.0, 210.0, 210.0)
    assert profile.material.density_g_cm3 == 1.24
    assert profile.stability.lean_deg == 10.0
    assert profile.stability.lean_margin_deg == 0.5
    assert (profile.stability.base_seat_mm, profile.stability.base_growth_max_mm) == (1.0, 3.0)
    assert profile.slicer.check_with == "prusa-slicer"
    assert profile.slicer.object_settings == {
        "fill_density": "100%",
        "fill_pattern": "rectilinear",
        "support_material_buildplate_only": "1",
    }


@pytest.mark.parametrize(
    ("wall_mm", "perimeters"), [(1.2, None), (1.8, None), (2.0, "3"), (2.7, "3"), (3.0, "4")]
)
def test_thick_walls_are_all_perimeters(wall_mm: float, perimeters: str | None) -> None:
    profile = load_profile("fdm-pla-0.4", {"wall_mm": wall_mm})
    assert profile.object_settings.get("perimeters") == perimeters
    rest = {key: value for key, value in profile.object_settings.items() if key != "perimeters"}
    assert rest == profile.slicer.object_settings
    own = {"wall_mm": wall_mm, "slicer.object_settings.perimeters": "7"}
    assert load_profile("fdm-pla-0.4", own).object_settings["perimeters"] == "7"


def test_powder_has_no_perimeters() -> None:
    assert load_profile("sls-pa12", {"wall_mm": 5.0}).object_settings == {}


@pytest.mark.parametrize("name", NAMES)
def test_every_figure_has_its_source_beside_it(name: str) -> None:
    """Each line that sets a number carries a comment; first_layer follows from layer_height."""
    for line in profile_source(name).splitlines():
        key, is_setting, value = line.partition("=")
        if is_setting and not line.startswith("#") and key.strip() != "first_layer_mm":
            number = value.strip()[0].isdigit() or value.strip().startswith("[")
            assert not number or "#" in value or key.strip() == "count", line


def test_source_is_the_toml_that_was_loaded() -> None:
    data = tomllib.loads(profile_source("resin-standard"))
    assert data["wall_mm"] == load_profile("resin-standard").wall_mm == 2.0


@pytest.mark.parametrize("name", NAMES[3:])
def test_where_there_is_no_nozzle_there_are_no_nozzle_figures(name: str) -> None:
    printer = load_profile(name).printer
    assert printer.nozzle_mm is None
    assert printer.line_width_mm is None


def test_a_path_works_wherever_a_name_does(tmp_path: Path) -> None:
    path = tmp_path / "my printer.toml"
    path.write_text(
        profile_source("fdm-pla-0.4").replace("wall_mm = 1.2", "wall_mm = 1.6"), encoding="utf-8"
    )
    for form in (path, str(path)):
        assert load_profile(form).wall_mm == 1.6
        assert load_profile(form).name == "my printer"
        assert "1.6" in profile_source(form)


def test_a_loaded_profile_passes_through_and_can_be_overridden_again() -> None:
    first = load_profile("fdm-pla-0.4", {"wall_mm": 2})
    assert load_profile(first) == first
    second = load_profile(first, {"stability.lean_deg": 12})
    assert (second.wall_mm, second.stability.lean_deg) == (2.0, 12.0)
    assert first.stability.lean_deg == 10.0


@given(st.floats(0.45, 50.0), st.floats(0.0, 60.0))
def test_overrides_as_numbers_and_as_text_agree(wall_mm: float, lean_deg: float) -> None:
    as_numbers = load_profile("fdm-pla-0.4", {"wall_mm": wall_mm, "stability.lean_deg": lean_deg})
    texts = {"wall_mm": repr(wall_mm), "stability.lean_deg": repr(lean_deg)}
    assert load_profile("fdm-pla-0.4", texts) == as_numbers
    assert as_numbers.wall_mm == wall_mm
    assert as_numbers.stability.lean_deg == lean_deg


def test_text_that_is_no_toml_value_is_taken_as_it_stands() -> None:
    overrides = {
        "slicer.object_settings.fill_density": "90%",
        "slicer.object_settings.perimeters": "3",
        "material.name": "PLA Silk",
        "printer.bed_mm": "[180, 180, 180]",
    }
    profile = load_profile("fdm-pla-0.4", overrides)
    assert profile.slicer.object_settings["fill_density"] == "90%"
    assert profile.slicer.object_settings["perimeters"] == "3"
    assert profile.material.name == "PLA Silk"
    assert profile.printer.bed_mm == (180.0, 180.0, 180.0)


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"wal_mm": 1}, ["wal_mm is unknown", "wall_mm"]),
        ({"printer.nozle_mm": 1}, ["printer.nozle_mm is unknown", "nozzle_mm"]),
        ({"wall_mm": 99}, ["wall_mm is 99", "between 0.2 and 50"]),
        ({"wall_mm": "thick"}, ["wall_mm is 'thick'", "between 0.2 and 50"]),
        ({"wall_mm": "true"}, ["wall_mm is True", "between 0.2 and 50"]),
        ({"wall_mm": float("nan")}, ["wall_mm is nan", "between 0.2 and 50"]),
        ({"wall_mm": 0.3}, ["wall_mm is 0.3", "between 0.45 and 50"]),  # under one line
        ({"stability.lean_deg": -1}, ["stability.lean_deg is -1", "between 0 and 60"]),
        ({"printer.layer_height_mm": 0.5}, ["layer_height_mm is 0.5", "between 0 and 0.4"]),
        ({"printer.bed_mm": [250, 210]}, ["printer.bed_mm", "three numbers"]),
        ({"printer.bed_mm": [1, 210, 210]}, ["printer.bed_mm", "between 10 and 5000"]),
        ({"drain.count": 1.5}, ["drain.count is 1.5", "between 0 and 16"]),
        ({"drain.count": 1}, ["drain.diameter_mm is needed"]),
        ({"process": "laser"}, ["process is 'laser'", "must be fdm, resin"]),
        ({"process": "resin"}, ["printer.nozzle_mm has no meaning for resin"]),
        ({"name": "mine"}, ["name", "cannot be overridden"]),
        ({"wall_mm.x": 1}, ["wall_mm.x", "not a table"]),
        ({"slicer.check_with": "cura"}, ["slicer.check_with is 'cura'", "prusa-slicer"]),
        ({"slicer.object_settings.post_process": "rm"}, ["post_process", "runs commands"]),
        ({"slicer.object_settings.fill_density": [1]}, ["slicer.object_settings.fill_density"]),
    ],
)
def test_an_invalid_value_is_named_with_profile_key_and_range(
    overrides: dict[str, object], says: list[str]
) -> None:
    with pytest.raises(UsageError) as caught:
        load_profile("fdm-pla-0.4", overrides)
    for part in says:
        assert part in caught.value.message


def test_errors_in_a_file_name_the_file(tmp_path: Path) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(
        profile_source("fdm-pla-0.4").replace("lean_deg = 10.0", "lean_deg = 95"), encoding="utf-8"
    )
    with pytest.raises(UsageError, match=r"mine\.toml: stability\.lean_deg is 95.*0 and 60"):
        load_profile(path)
    path.write_text(profile_source("fdm-pla-0.4").replace("wall_mm = 1.2", ""), encoding="utf-8")
    with pytest.raises(UsageError, match=r"mine\.toml: wall_mm is missing.*0\.2 and 50"):
        load_profile(path)
    path.write_text("wall_mm = ")
    with pytest.raises(UsageError, match=r"mine\.toml is not valid TOML"):
        load_profile(path)
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(UsageError, match=r"mine\.toml cannot be read"):
        load_profile(path)


def test_an_unknown_name_gets_the_nearest_one() -> None:
    with pytest.raises(UsageError) as caught:
        load_profile("fdm-pla-04")
    assert caught.value.hint == "Did you mean fdm-pla-0.4?"
    with pytest.raises(UsageError, match=r"profile file nowhere/else\.toml does not exist"):
        load_profile("nowhere/else.toml")


def test_profiles_cannot_be_changed() -> None:
    profile = load_profile()
    with pytest.raises(ValidationError):
        profile.wall_mm = 3.0  # type: ignore[misc]
    assert isinstance(profile, Profile)


def test_any_folder_will_do(tmp_path: Path) -> None:
    root = Path(__file__).resolve().parents[2]
    code = (
        f"import sys; sys.path.insert(0, {str(root)!r})\n"
        "from printprep.profiles import load_profile\nprint(load_profile().wall_mm)"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        capture_output=True,
        encoding="utf-8",
        check=True,
    )
    assert done.stdout.strip() == "1.2"


def test_loading_takes_milliseconds() -> None:
    load_profile()
    began = time.perf_counter()
    for _ in range(20):
        load_profile("resin-standard", {"wall_mm": 3})
    assert (time.perf_counter() - began) / 20 < 0.02  # measured 0.0009 s
