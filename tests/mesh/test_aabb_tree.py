"""Rays through Embree and through libigl, and the trees that are kept."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from manifold3d import Manifold

from printprep.mesh import aabb_tree
from printprep.mesh.aabb_tree import SurfaceTree, tree_of
from printprep.mesh.measure import arrays
from printprep.mesh.quantize import quantized_arrays


def ball(radius: float = 10.0) -> tuple[np.ndarray, np.ndarray]:
    return arrays(Manifold.sphere(radius, 64))


def without_embree(tree: SurfaceTree) -> SurfaceTree:
    tree.__dict__["_scene"] = None
    return tree


@pytest.mark.parametrize("embree", [True, False])
def test_a_ray_across_a_cube_is_as_long_as_its_side(embree: bool) -> None:
    tree = SurfaceTree(*arrays(Manifold.cube((2, 3, 4))))
    if not embree:
        without_embree(tree)
    starts = np.array([[0.7, 1.1, 0.0], [0.3, 0.0, 1.3], [0.0, 1.9, 2.2], [1.0, 1.0, 9.0]])
    along = np.array([[0, 0, 1.0], [0, 1.0, 0], [1.0, 0, 0], [0, 0, 1.0]])
    far, face = tree.first_hit(starts, along)
    assert far[:3] == pytest.approx([4, 3, 2], abs=1e-6)
    assert far[3] == np.inf and face[3] == -1
    assert (face[:3] >= 0).all()


@examples(20)
@given(st.integers(0, 2**32 - 1), st.floats(1, 500), st.floats(-1e3, 1e3))
def test_both_ways_find_the_same_hits(seed: int, radius: float, away: float) -> None:
    rng = np.random.default_rng(seed)
    vertices, faces = ball(radius)
    tree = SurfaceTree(vertices + away, faces)
    starts = away + rng.uniform(-1.5, 1.5, (200, 3)) * radius
    along = rng.normal(size=(200, 3))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    far, _ = tree.first_hit(starts, along)
    exact, _ = tree.first_hit_exactly(starts, along)
    hit = np.isfinite(exact)
    assert (np.isfinite(far) == hit).mean() > 0.99  # a ray may graze the silhouette
    both = hit & np.isfinite(far)
    assert np.allclose(far[both], exact[both], atol=1e-3 * radius)
    # What is hit within a length may be hit; what surely is not, is not
    shorter = both & (exact < 0.9 * radius)
    assert tree.may_hit(starts[shorter], along[shorter], np.full(shorter.sum(), radius)).all()
    assert without_embree(tree).may_hit(starts, along, np.ones(200)).all()


def test_a_hit_is_calculated_in_double_precision() -> None:
    vertices, faces = arrays(Manifold.cube((1, 1, 1)))
    tree = SurfaceTree(vertices + 1e4, faces)
    start = np.array([[1e4 + 0.3, 1e4 + 0.6, 1e4 + 0.25]])
    far, _ = tree.first_hit(start, np.array([[0.0, 0.0, 1.0]]))
    assert far[0] == pytest.approx(0.75, abs=1e-9)


def test_the_tree_of_the_same_mesh_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    vertices, faces = ball()
    first = tree_of(vertices, faces)
    assert tree_of(vertices.copy(), faces.copy()) is first
    moved = vertices.copy()
    moved[0, 0] += 1e-9
    assert tree_of(moved, faces) is not first
    tree_of(moved, faces)
    before = moved.copy()
    moved *= 2  # what the caller does with his array changes no tree
    assert np.array_equal(tree_of(before, faces).vertices, before)
    assert tree_of(vertices, faces) is first
    monkeypatch.setattr(aabb_tree, "_MOST_FACES", 3 * len(faces))  # the last three are kept
    for radius in (1, 2, 3):
        tree_of(*ball(radius))
    assert tree_of(vertices, faces) is not first


@examples(30)
@given(st.integers(0, 2**32 - 1), st.integers(1, 60))
def test_long_triangles_are_searched_in_pieces(seed: int, count: int) -> None:
    # Each piece answers for its triangle; judged by every distance there is
    rng = np.random.default_rng(seed)
    vertices = rng.uniform(-1, 1, (3 * count, 3)) * [100, 1, 10]
    faces = np.arange(3 * count).reshape(-1, 3)
    tree = SurfaceTree(vertices, faces)
    points = rng.uniform(-2, 2, (50, 3)) * [60, 30, 30]
    distance, nearest, face = tree.nearest_faces(points)
    each = trimesh.triangles.closest_point(
        np.repeat(vertices[faces], 50, axis=0), np.tile(points, (count, 1))
    ).reshape(count, 50, 3)
    far = np.linalg.norm(each - points, axis=2)
    assert distance == pytest.approx(far.min(axis=0), rel=1e-9, abs=1e-9)
    assert np.linalg.norm(nearest - points, axis=1) == pytest.approx(distance, rel=1e-9)
    assert far[face, np.arange(50)] == pytest.approx(distance, rel=1e-9, abs=1e-9)
    corners = vertices[faces[face]]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    assert np.einsum("ij,ij->i", nearest - corners[:, 0], normal) == pytest.approx(0, abs=1e-6)
    starts = np.column_stack([rng.uniform(-100, 100, 200), np.zeros(200), np.full(200, -20.0)])
    up = np.tile([0.0, 0.0, 1.0], (200, 1))
    hit, met = tree.first_hit_exactly(starts, up)
    assert ((met >= 0) == np.isfinite(hit)).all()
    at = starts + np.where(met >= 0, hit, 0.0)[:, None] * up
    off = trimesh.triangles.closest_point(vertices[faces[met]], at) - at
    assert np.linalg.norm(off, axis=1)[met >= 0] == pytest.approx(0, abs=1e-4)


def test_many_long_slivers_stay_whole() -> None:
    # a cylinder of 40,000 sides: pieces of all would be more than the tree gains
    vertices, faces = arrays(Manifold.cylinder(100, 10, 10, 20_000))
    tree = SurfaceTree(vertices, faces)
    assert len(tree._pieces.faces) <= aabb_tree.MOST_PIECES * len(faces) + aabb_tree.FEW_FACES
    assert tree.nearest(np.array([[0.0, 0.0, 50.0]]))[0] == pytest.approx(10, rel=1e-6)


def test_few_trees_are_kept_however_small() -> None:
    # Embree crashes where some thousand scenes are held: a batch ended so
    faces = np.array([[0, 1, 2]])
    for number in range(3 * aabb_tree._MOST_TREES):
        tree_of(np.eye(3) + number, faces)
    assert len(aabb_tree._KEPT) == aabb_tree._MOST_TREES


@examples(20)
@given(st.integers(0, 2**32 - 1), st.integers(1, 3))
def test_trees_of_shells_answer_like_one_tree(seed: int, voids: int) -> None:
    rng = np.random.default_rng(seed)
    solid = Manifold.sphere(10, 40)
    for number in range(voids):
        hole = Manifold.cube((1.2, 1.2, 1.2)).rotate(rng.uniform(0, 90, 3).tolist())
        solid -= hole.translate([5.0 * number - 5.0, -1, -1])
    vertices, faces = arrays(solid)
    one = SurfaceTree(vertices, faces)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(aabb_tree, "MANY_FACES", 0)
        several = tree_of(vertices, faces)
    assert isinstance(several, aabb_tree._ShellTrees) and len(several._shells) == voids + 1
    points = rng.uniform(-12, 12, (300, 3))
    along = rng.normal(size=(300, 3))
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    distance, place, face = several.nearest_faces(points)
    assert distance == pytest.approx(one.nearest(points)[0], rel=1e-12, abs=1e-12)
    assert np.linalg.norm(place - points, axis=1) == pytest.approx(distance, rel=1e-9)
    corners = vertices[faces[face]]
    near = trimesh.triangles.closest_point(corners, points)
    assert np.linalg.norm(near - points, axis=1) == pytest.approx(distance, rel=1e-9, abs=1e-9)
    for ask in ("first_hit", "first_hit_exactly"):
        far, met = getattr(several, ask)(points, along)
        expected, expected_met = getattr(one, ask)(points, along)
        assert (met == expected_met).mean() > 0.98  # a ray may pass between two triangles
        assert np.allclose(far[met == expected_met], expected[met == expected_met], atol=1e-6)
    within = rng.uniform(0, 20, 300)
    assert (several.may_hit(points, along, within) == one.may_hit(points, along, within)).all()


def test_the_tree_of_a_shell_serves_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(aabb_tree, "MANY_FACES", 1000)
    outside = Manifold.sphere(10, 64)
    part = outside - Manifold.sphere(5, 64)
    alone = tree_of(*quantized_arrays(outside))
    together = tree_of(*quantized_arrays(part))
    assert isinstance(together, aabb_tree._ShellTrees)
    assert any(shell is alone for shell in together._shells)
