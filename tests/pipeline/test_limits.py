"""Limits that are checked before any work: sizes, and memory."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import trimesh

from printprep import hollow
from printprep.errors import GeometryError, InputError, PrintprepError, UsageError
from printprep.pipeline.limits import MOST_BEDS, check_size, estimated_mib, length
from printprep.pipeline.options import AS_IN_FILE
from printprep.profiles import load_profile
from printprep.types import Model

PLA = load_profile("fdm-pla-0.4")


def cube(side: float) -> trimesh.Trimesh:
    return trimesh.creation.box((side,) * 3)


def model(side: float) -> Model:
    made = cube(1.0)
    return Model(np.asarray(made.vertices) * side, np.asarray(made.faces), np.eye(4), "cube")


@pytest.mark.parametrize("side", [150e3, 2e31, 1e300, 0.19, 1e-30, 2e-319])
def test_a_size_that_no_printer_knows_is_told_at_once(side: float) -> None:
    mesh = trimesh.Trimesh(model(side).vertices, model(side).faces, process=False)
    with pytest.raises(GeometryError) as told:
        hollow(mesh)
    assert "--units" in str(told.value.hint)
    assert "long" in told.value.message


@pytest.mark.parametrize(
    "options",
    [
        {"scale": 1e12},
        {"scale": 1e7},
        {"scale": 1e-30},
        {"scale": 1e308},
        {"size_mm": 1e6},
        {"size_mm": 1e-300},
        {"height_mm": 1e-9},
    ],
)
def test_an_option_that_asks_for_such_a_size_is_named(options: dict[str, float]) -> None:
    (name,) = options
    with pytest.raises(PrintprepError) as told:
        hollow(cube(20.0), **options)
    assert told.value.exit_code in (2, 4)
    if told.value.exit_code == 2:
        assert f"--{name.removesuffix('_mm')}" in told.value.message


@pytest.mark.parametrize("side", [2e-319, 2e31, 1e300])
def test_a_size_that_can_be_scaled_away_is(side: float) -> None:
    mesh = trimesh.Trimesh(model(side).vertices, model(side).faces, process=False)
    try:
        result = hollow(mesh, size_mm=10, resolution=8, base="never")
    except GeometryError as refused:  # a subnormal number has no factor
        assert side < 1e-300 and "too small" in refused.message
    else:
        assert result.part.manifold.volume() <= 1000 + 1e-3


def test_both_sides_of_the_size_limits() -> None:
    most = MOST_BEDS * max(PLA.printer.bed_mm)
    check_size(model(most), PLA, AS_IN_FILE)
    check_size(model(0.2), PLA, AS_IN_FILE)
    for side in (most * 1.001, 0.199):
        with pytest.raises(GeometryError):
            check_size(model(side), PLA, AS_IN_FILE)
    with pytest.raises(UsageError, match="--size"):
        check_size(model(most * 2), PLA, replace(AS_IN_FILE, size_mm=most * 2))


@pytest.mark.parametrize(
    ("triangles", "size", "resolution", "measured"),
    [
        (70_000, (48, 73, 100), 64, 491),
        (1_120_000, (48, 73, 100), 64, 3079),
        (423_424, (52, 99, 100), 64, 1393),
        (1_693_696, (52, 99, 100), 64, 4527),
    ],
)
def test_the_estimate_of_memory_holds_and_is_not_idle(
    triangles: int, size: tuple[float, float, float], resolution: int, measured: float
) -> None:
    """measured : peak resident memory of whole runs, MiB."""
    estimate = estimated_mib(triangles, size, PLA, resolution)
    assert measured <= estimate <= 2.0 * measured


def test_what_does_not_fit_is_refused_before_it_runs() -> None:
    with pytest.raises(InputError, match="100 MiB that --max-memory allows"):
        hollow(cube(20.0), max_memory_mib=100)
    with pytest.raises(InputError, match="MiB") as told:
        hollow(cube(20.0), resolution=512, max_memory_mib=2000)
    assert "--resolution" in str(told.value.hint)


def test_lengths_in_words() -> None:
    assert length(150_000) == "150 m"
    assert length(42.5) == "42.5 mm"
