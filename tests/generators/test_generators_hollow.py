"""hollow(): what goes to the generator's second stage, and the cavity in its frame."""

import subprocess
import sys

import numpy as np
import pytest
import torch
from hypothesis import given
from hypothesis import strategies as st

from printprep.errors import InputError, UsageError
from printprep.generators import GRID, hollow, surface_of
from printprep.paper.settings import PaperSettings


def _surface():
    """The surface voxels of a leaning ellipsoid, as a generator gives them."""
    axis = np.arange(GRID) - 31.5
    x, y, z = np.meshgrid(axis, axis, axis, indexing="ij")
    solid = ((x - 0.3 * z) / 18) ** 2 + (y / 14) ** 2 + (z / 25) ** 2 <= 1
    core = solid.copy()
    for ax in range(3):
        core &= np.roll(solid, 1, ax) & np.roll(solid, -1, ax)
    return solid, solid & ~core


def _edges(faces):
    directed = faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2)
    return {tuple(edge) for edge in directed}, len(directed)


def _volume(surface):
    a, b, c = (surface.vertices[surface.faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)


def test_coordinates_through_both_stages():
    solid, surface = _surface()
    coords = torch.from_numpy(np.insert(np.argwhere(surface), 0, 0, axis=1)).int()
    result = hollow(coords)
    material = result.material
    assert material.dtype == torch.int32
    assert material.shape[1] == 4
    assert (material[:, 0] == 0).all()
    given_, kept = {tuple(v) for v in coords.tolist()}, {tuple(v) for v in material.tolist()}
    assert given_ <= kept
    assert len(kept) == len(material) == result.material_voxels.sum()
    assert np.array_equal(result.domain.solid, solid)
    assert np.array_equal(result.cavity_voxels, solid & ~result.material_voxels)
    assert not (result.material_voxels & ~solid & ~result.domain.base).any()
    assert 0.2 < result.mass_ratio < 0.9


def test_every_form_gives_the_same_material():
    solid, surface = _surface()
    expected = hollow(surface).material
    assert expected.dtype == bool
    from_coordinates = hollow(np.argwhere(surface)).material
    assert np.array_equal(from_coordinates, np.argwhere(expected))
    assert np.array_equal(hollow(solid.astype(np.uint8)).material, expected.astype(np.uint8))


def test_cavity_lies_in_the_generators_frame():
    """Its centroid is that of the cavity voxels, at (index + 0.5) / 64 − 0.5, z up."""
    result = hollow(_surface()[1])
    index = np.argwhere(result.cavity_voxels)
    low = index.min(axis=0) / GRID - 0.5
    high = (index.max(axis=0) + 1) / GRID - 0.5
    vertices = result.cavity.vertices
    assert vertices.min(axis=0) == pytest.approx(low, abs=1e-4)
    assert vertices.max(axis=0) == pytest.approx(high, abs=1e-4)
    assert 0.9 < _volume(result.cavity) * GRID**3 / len(index) < 1.0
    turned = result.cavity.turned_y_up()
    assert turned.vertices[:, 1] == pytest.approx(vertices[:, 2])
    assert turned.vertices[:, 2] == pytest.approx(-vertices[:, 1])
    assert _volume(turned) == pytest.approx(_volume(result.cavity))


@given(seed=st.integers(0, 10_000), share=st.sampled_from([0.05, 0.3, 0.5, 0.7, 0.95]))
def test_surfaces_are_closed_and_point_outward(seed, share):
    voxels = np.random.default_rng(seed).random((7, 7, 7)) < share
    surface = surface_of(voxels)
    edges, count = _edges(surface.faces)
    assert len(edges) == count, "an edge is used twice in one direction"
    assert all((b, a) in edges for a, b in edges)
    assert _volume(surface) > 0 or not voxels.any()
    assert np.abs(surface.vertices).max(initial=0) <= 0.5


def test_one_voxel_is_an_octahedron():
    voxels = np.zeros((4, 4, 4), dtype=bool)
    voxels[0, 1, 2] = True
    surface = surface_of(voxels)
    assert len(surface.faces) == 8
    centre = np.array([-0.375, -0.125, 0.125])
    assert surface.vertices.mean(axis=0) == pytest.approx(centre)
    assert _volume(surface) == pytest.approx((4 / 3) * 0.125**3, rel=0.01)


def test_solve_takes_another_program():
    asked = []

    def shell_only(domain):
        asked.append(domain)
        return domain.shell.astype(float)

    result = hollow(_surface()[1], solve=shell_only)
    assert len(asked) == 1
    assert np.array_equal(result.material, result.domain.shell)
    filled = hollow(_surface()[1], solve=lambda domain: np.ones(domain.shape))
    assert filled.cavity.faces.shape == (0, 3)
    assert not filled.cavity_voxels.any()
    # A density off the solid and its base is not material, whatever a program says.
    assert np.array_equal(filled.material, filled.domain.solid | filled.domain.base)


def test_adam_and_plane_agree():
    settings = PaperSettings()
    plane = hollow(_surface()[1], objective="paper", settings=settings)
    adam = hollow(_surface()[1], objective="paper", settings=settings, solver="adam")
    assert (adam.material == plane.material).mean() >= 0.998


def test_a_leaking_surface():
    _, surface = _surface()
    top = np.argwhere(surface)[:, 2].max()
    surface[31, 31, top - 1 : top + 1] = False
    surface[:, :, top] &= False
    assert not hollow(surface).cavity_voxels.any()
    held = hollow(surface, filling="slices", shell="occupied")
    assert held.domain.solid.sum() > 2 * surface.sum()


def test_nothing_to_hollow_is_not_an_error():
    voxels = np.zeros((GRID,) * 3, dtype=bool)
    voxels[20:40, 30:32, 10:50] = True
    result = hollow(voxels, settings=PaperSettings(base=False))
    assert np.array_equal(result.material, voxels)
    assert result.cavity.vertices.shape == (0, 3)
    assert result.mass_ratio == 1.0


def test_refusals():
    _, surface = _surface()
    with pytest.raises(UsageError, match="objective"):
        hollow(surface, objective="lightest")
    with pytest.raises(UsageError, match="solver"):
        hollow(surface, solver="guess")
    with pytest.raises(UsageError, match="cpu"):
        hollow(surface, device="cuda")
    with pytest.raises(UsageError, match="belong to an objective"):
        hollow(surface, solver="adam", solve=lambda domain: domain.shell.astype(float))
    with pytest.raises(UsageError, match="shape"):
        hollow(surface, solve=lambda domain: np.zeros(3))
    with pytest.raises(InputError, match="no voxel"):
        hollow(np.zeros((GRID,) * 3))


def test_the_package_does_not_import_torch_or_skimage():
    code = (
        "import sys, printprep.generators; print({'torch', 'skimage', 'scipy'} & set(sys.modules))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True
    )
    assert done.stdout.strip() == "set()"
