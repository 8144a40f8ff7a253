"""Figures in words: filament, volume, cost, hours, commands, the chart's numbers."""

from __future__ import annotations

import math
from itertools import pairwise

import pytest
from hypothesis import given
from hypothesis import strategies as st

from printprep.cli.shown_command import without_folders
from printprep.errors import UsageError
from printprep.page.chart import ticks
from printprep.page.words import cost, hours, mass, material_used, tilt
from printprep.profiles import load_profile


def test_filament_is_a_length():
    """12.4 g of PLA are 10 cm³; over π/4 · 1.75² mm² that is 4.157 m."""
    metres = 10_000 / (math.pi / 4 * 1.75**2) / 1000
    assert material_used(12.4, load_profile("fdm-pla-0.4")) == (
        f"{metres:.3g} m",
        "of 1.75 mm filament",
    )
    thick = load_profile("fdm-pla-0.4", {"printer.filament_mm": 2.85})
    assert material_used(12.4, thick) == ("1.57 m", "of 2.85 mm filament")


def test_resin_is_a_volume():
    profile = load_profile("resin-standard", {"material.density_g_cm3": 1.1})
    assert material_used(11.0, profile)[0] == "10 ml"


def test_cost_is_the_profiles_price_in_its_currency():
    assert cost(50.0, load_profile()) is None
    priced = load_profile("fdm-pla-0.4", {"material.price_per_kg": 24.0})
    assert cost(50.0, priced) == "1.20"
    euros = load_profile(priced, {"material.currency": "€"})
    assert cost(50.0, euros) == "1.20 €"


@pytest.mark.parametrize("key", ["material.price_per_kg", "printer.filament_mm"])
@pytest.mark.parametrize("value", ["-1", "nan", "inf", "x"])
def test_an_impossible_price_or_diameter_is_refused(key, value):
    with pytest.raises(UsageError, match=key):
        load_profile("fdm-pla-0.4", {key: value})


def test_resin_has_no_filament():
    with pytest.raises(UsageError, match="filament_mm has no meaning"):
        load_profile("resin-standard", {"printer.filament_mm": 1.75})


def test_small_words():
    assert [hours(s) for s in (None, 59 * 60, 3660, 86_400)] == [
        "unknown", "59 min", "1 h 01 min", "24 h 00 min",
    ]  # fmt: skip
    assert [tilt(a) for a in (None, 3.04, -39.2)] == ["no contact", "3.0°", "−39.2°"]
    assert [mass(m) for m in (0.0, 0.05, 12.345, 1234.5)] == ["0 g", "50 mg", "12.3 g", "1.23 kg"]


@pytest.mark.parametrize(
    ("arguments", "shown"),
    [
        (["hollow", "/home/me/a b.stl", "-o", "../x/o.3mf"], "printprep hollow 'a b.stl' -o o.3mf"),
        (["hollow", "a.stl", "--report=/tmp/r.html"], "printprep hollow a.stl --report=r.html"),
        (["hollow", r"C:\Users\me\a.stl"], "printprep hollow a.stl"),
        (["hollow", "a.stl", "--lean", "15@90", "--set", "wall_mm=2"],
         "printprep hollow a.stl --lean 15@90 --set wall_mm=2"),
        (["batch", "models/", "-o", "/"], "printprep batch models -o /"),
    ],
)  # fmt: skip
def test_a_command_names_files_without_folders(arguments, shown):
    assert without_folders(arguments) == shown


@given(low=st.floats(-90, 0), high=st.floats(1e-3, 1e6))
def test_ticks_span_the_range_with_few_round_numbers(low, high):
    found = ticks(low, high)
    slack = 1e-6 * (high - low)
    assert found[0] <= low + slack and found[-1] >= high - slack
    assert 2 <= len(found) <= 9
    steps = {round(b - a, 9) for a, b in pairwise(found)}
    assert max(steps) - min(steps) < 1e-6 * max(steps)
