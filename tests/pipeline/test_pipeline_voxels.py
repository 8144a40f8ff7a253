"""Voxels of a generator as a model: the solid they mean, hollowed like any other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from printprep.errors import InputError
from printprep.generators.model import read_model
from printprep.pipeline.hollow import hollow
from printprep.types import VaultChoice


def surface_voxels(side: int) -> np.ndarray:
    """Coordinates (n, 3) of the surface voxels of a cube in a 64³ grid."""
    solid = np.zeros((64, 64, 64), dtype=bool)
    solid[10 : 10 + side, 10 : 10 + side, 10 : 10 + side] = True
    inner = np.zeros_like(solid)
    inner[11 : 9 + side, 11 : 9 + side, 11 : 9 + side] = True
    return np.argwhere(solid & ~inner)


@pytest.mark.parametrize("vaults", ["none", pytest.param(None, marks=pytest.mark.slow)])
def test_surface_voxels_are_hollowed_as_the_solid_they_enclose(
    tmp_path: Path, vaults: VaultChoice | None
) -> None:
    path = tmp_path / "cube.npz"
    np.savez(path, coords=surface_voxels(32))
    result = hollow(path, size_mm=40.0, resolution=32, vaults=vaults)
    # Half a voxel of each edge is bevelled by marching cubes.
    assert result.solid_mass_g == pytest.approx(64 * 1.24, rel=0.01)
    assert result.wall_min_mm >= 1.2 - 0.05  # type: ignore[operator]
    assert result.mass_g < 0.25 * result.solid_mass_g


def test_the_frame_is_the_generators(tmp_path: Path) -> None:
    path = tmp_path / "cube.npy"
    np.save(path, surface_voxels(32))
    raw = read_model(path)
    # Voxels 10 to 41: faces at index 10 and 42 of 64.
    assert raw.vertices.min() == pytest.approx(10 / 64 - 0.5, abs=1e-3)
    assert raw.vertices.max() == pytest.approx(42 / 64 - 0.5, abs=1e-3)


def test_a_pickle_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "objects.npy"
    np.save(path, np.array([{"a": 1}], dtype=object), allow_pickle=True)
    with pytest.raises(InputError):
        hollow(path)
