"""What a file of float32 holds is one clean manifold, near the part, and stays what it is."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from closed_form_parts import box, hollow_box
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.errors import GeometryError
from printprep.mesh.measure import from_arrays
from printprep.mesh.quantize import crowded_edges, quantized, quantized_arrays

TOUCHING = {
    "two boxes along an edge": lambda: box(10) + box(10).translate((10, 10, 0)),
    "two voids along an edge": lambda: box(40) - box(8, z=5) - box(8, z=5).translate((8, 8, 0)),
    "a slot that meets a slot": lambda: (
        box(30) - box(10, 40, z=-5).translate((0, -5, 0)) - box(10, 40, z=-5).translate((10, 5, 0))
    ),
    "turned": lambda: (box(10) + box(10).translate((10, 10, 0))).rotate((31, 17, 5)),
}


@pytest.mark.parametrize("name", TOUCHING)
def test_touching_edges_are_drawn_apart(name):
    part = TOUCHING[name]()
    assert len(crowded_edges(quantized_arrays(part)[1])), "the case is no case"
    written = quantized(part)
    assert not len(crowded_edges(quantized_arrays(written)[1]))
    assert written.volume() == pytest.approx(part.volume(), rel=1e-4)
    # No vertex strays by a thousandth of a millimetre.
    before, _ = quantized_arrays(part)
    after, _ = quantized_arrays(written)
    apart = np.linalg.norm(after[:, None] - before[None], axis=2).min(axis=1)
    assert apart.max() < 1e-3


def test_where_only_corners_touch_nothing_moves():
    """Moved apart there, surfaces may begin to touch along an edge beside it (a boot did)."""
    edge = box(10) + box(10).translate((10, 10, 0))
    corner = box(10).translate((20, 20, 10))
    part = edge + corner
    before, after = (quantized_arrays(each)[0] for each in (part, quantized(part)))
    stayed = set(map(tuple, after.tolist()))
    moved = [point for point in before.tolist() if tuple(point) not in stayed]
    assert sorted(moved) == [[5.0, 5.0, 0.0], [5.0, 5.0, 10.0]]  # the ends of the shared edge


@pytest.mark.parametrize("name", TOUCHING)
def test_it_changes_nothing_twice(name):
    once = quantized(TOUCHING[name]())
    twice = quantized(once)
    assert quantized(twice) is twice
    for first, second in zip(quantized_arrays(once), quantized_arrays(twice), strict=True):
        assert np.array_equal(first, second)


@given(
    turn=st.tuples(*[st.floats(-180, 180)] * 3),
    shift=st.tuples(*[st.floats(-200, 200)] * 3),
    segments=st.integers(3, 24),
)
def test_any_pose_comes_out_clean_and_near(turn, shift, segments):
    shape = Manifold.sphere(20, segments) - box(9, z=-4)
    part = shape.rotate(turn).translate(shift)
    vertices, faces = quantized_arrays(quantized(part))
    assert not len(crowded_edges(faces))
    assert np.array_equal(vertices, vertices.astype(np.float32))
    a, b, c = np.moveaxis(vertices[faces] - vertices.mean(axis=0), 1, 0)
    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6
    # Every coordinate is off by at most 1.5e-5 mm: so is the volume, by that times the area.
    assert abs(volume - part.volume()) < 3e-5 * part.surface_area()


def test_arrays_do_not_depend_on_the_order_of_the_mesh():
    from printprep.mesh.measure import arrays, from_arrays

    vertices, faces = arrays(hollow_box(20, 2))
    generator = np.random.default_rng(7)
    order = generator.permutation(len(vertices))
    shuffled = from_arrays(vertices[np.argsort(order)], order[generator.permutation(faces)])
    for one, other in zip(
        quantized_arrays(hollow_box(20, 2)), quantized_arrays(shuffled), strict=True
    ):
        assert np.array_equal(one, other)


def test_vertices_that_a_reader_would_join_are_joined():
    """Near the origin single precision holds two vertices 2e-9 mm apart; trimesh joins them."""
    x, y = [0, 2e-9, 9, 0], [0, 0, 0, 9]
    corners = np.array([*zip(x, y, [0] * 4, strict=True), *zip(x, y, [9] * 4, strict=True)])
    sides = [
        f for i, j in ((0, 1), (1, 2), (2, 3), (3, 0)) for f in ((i, j, j + 4), (i, j + 4, i + 4))
    ]
    ends = [(0, 2, 1), (0, 3, 2), (4, 5, 6), (4, 6, 7)]
    prism = from_arrays(corners, np.array(sides + ends))
    assert prism.num_vert() == 8
    vertices, faces = quantized_arrays(quantized(prism))
    assert np.array_equal(vertices * 2**20, np.rint(vertices * 2**20))
    read = trimesh.Trimesh(vertices, faces)  # merges
    assert read.is_watertight and len(read.vertices) == len(vertices)


def test_flat_shells_are_dropped_and_thick_ones_kept():
    speck = Manifold.cube((0.5, 0.5, 0.5)).translate((30, 0, 0))
    sliver = Manifold.cube((2, 2, 0.004)).translate((0, 0, 40))
    flat_void = Manifold.cube((2, 2, 0.004)).translate((0, 0, 5))
    written = quantized(Manifold.compose([box(20) - flat_void, speck, sliver]))
    assert sorted(round(shell.volume(), 3) for shell in written.decompose()) == [0.125, 8000]


def test_a_void_stays_a_void():
    assert quantized(hollow_box(20, 2)).volume() == pytest.approx(3904, rel=1e-6)


def test_nothing_left_is_an_error():
    with pytest.raises(GeometryError, match="Nothing of the part is left"):
        quantized(Manifold.cube((1, 1, 0.001)))


def test_crowded_edges_of_an_open_surface_are_its_rim():
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    assert crowded_edges(faces).tolist() == [[0, 1], [1, 2], [2, 3], [3, 0]]
