"""Meshes survive the way into a page: every triangle, to half a step of the grid."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from page_reader import meshes

from printprep.page.encode import STEPS, THICKNESS_STEP_MM, UNMEASURED, ViewMesh, encode

SIZES = st.floats(1e-3, 1e3)


def mesh_of(seed: int, count: int, triangles: int, size: float, layers: int) -> ViewMesh:
    rng = np.random.default_rng(seed)
    return ViewMesh(
        "part",
        rng.uniform(-size, size, (count, 3)),
        rng.random((triangles, count)).argsort(axis=1)[:, :3],  # three different corners
        rng.integers(0, layers, triangles),
        tuple(f"layer {number}" for number in range(layers)),
        np.where(rng.random(count) < 0.2, np.nan, rng.uniform(0, 90, count)),
    )


def corners(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """Triangles as their corners' places, each from its lowest place on, in a fixed order."""
    places = vertices[faces]
    first = np.array([min(range(3), key=lambda i, t=t: tuple(t[i])) for t in places])
    turned = np.take_along_axis(places, (first[:, None] + np.arange(3))[:, :, None] % 3, axis=1)
    flat = turned.reshape(len(faces), 9)
    return flat[np.lexsort(flat.T[::-1])]


@given(
    seed=st.integers(0, 10**6),
    count=st.integers(3, 40),
    triangles=st.integers(1, 40),
    size=SIZES,
    layers=st.integers(1, 4),
)
def test_every_triangle_comes_back(seed, count, triangles, size, layers):
    given_mesh = mesh_of(seed, count, triangles, size, layers)
    encoded = encode([given_mesh])
    vertices, faces, thickness = meshes(encoded.directory, encoded.base64)["part"]
    step = encoded.directory["step"]
    origin = np.array(encoded.directory["origin"])
    assert np.allclose(origin, given_mesh.vertices.min(axis=0))
    on_grid = np.rint((given_mesh.vertices - origin) / step)
    assert on_grid.max() == STEPS
    assert np.array_equal(
        corners(np.rint((vertices - origin) / step), faces), corners(on_grid, given_mesh.faces)
    )
    counts = [layer["triangles"] for layer in encoded.directory["meshes"][0]["layers"]]
    assert counts == np.bincount(given_mesh.classes, minlength=layers).tolist()
    known = np.sort(given_mesh.thickness_mm[np.isfinite(given_mesh.thickness_mm)])
    measured = np.sort(thickness[thickness < UNMEASURED * THICKNESS_STEP_MM - 1e-6])
    assert len(measured) == len(known)
    assert np.abs(measured - known).max(initial=0.0) <= THICKNESS_STEP_MM / 2 + 1e-9


def test_layers_are_ranges_of_triangles():
    """Triangles are sorted by layer, so that a viewer can show a layer by its range."""
    found = mesh_of(1, 40, 60, 10.0, 3)
    encoded = encode([found])
    vertices, faces, _ = meshes(encoded.directory, encoded.base64)["part"]
    start = 0
    for number, layer in enumerate(encoded.directory["meshes"][0]["layers"]):
        mine = corners(vertices, faces[start : start + layer["triangles"]])
        start += layer["triangles"]
        asked = corners(found.vertices, found.faces[found.classes == number])
        assert np.allclose(mine, asked, atol=encoded.directory["step"])


def test_all_meshes_are_on_one_grid():
    """Places that two meshes share are the same place after quantization too: no gap opens."""
    first = mesh_of(1, 30, 40, 10.0, 1)
    shifted = ViewMesh("other", first.vertices, first.faces, first.classes, ("layer 0",))
    far = np.vstack([first.vertices, [[500.0, 0.0, 0.0]]])
    large = ViewMesh("large", far, first.faces, first.classes, ("layer 0",))
    encoded = encode([first, shifted, large])
    found = meshes(encoded.directory, encoded.base64)
    assert np.array_equal(corners(*found["part"][:2]), corners(*found["other"][:2]))
    assert encoded.directory["step"] == pytest.approx((500 - far[:, 0].min()) / STEPS)


def test_the_same_meshes_are_the_same_text():
    assert encode([mesh_of(3, 50, 70, 5.0, 2)]) == encode([mesh_of(3, 50, 70, 5.0, 2)])


def test_a_flat_mesh_has_a_grid_too():
    point = ViewMesh("part", np.zeros((3, 3)), np.array([[0, 1, 2]]), np.array([0]), ("layer",))
    encoded = encode([point])
    assert meshes(encoded.directory, encoded.base64)["part"][0].tolist() == [[0.0] * 3] * 3
