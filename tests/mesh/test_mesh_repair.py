"""Each rung on defects made for it, with the volume the solid must have."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from examples import examples
from hypothesis import given
from hypothesis import strategies as st
from mesh_bodies import box, inside_out, joined, model, sphere

from printprep.children import Ended, HungError
from printprep.errors import GeometryError
from printprep.mesh import meshlab, meshlab_child, remesh
from printprep.mesh.measure import arrays, bodies, shells
from printprep.mesh.reference import Reference
from printprep.mesh.remesh import remeshed
from printprep.mesh.repair import repair
from printprep.mesh.shells import Candidate
from printprep.types import Solid

OUTER = box((0, 0, 0), (10, 10, 10))
HOLLOW = joined(OUTER, inside_out(box((2, 2, 2), (8, 8, 8))))


def check(solid: Solid, rung: str, volume: float, rel: float = 1e-9) -> None:
    assert (solid.repair.rung, solid.manifold.volume()) == (rung, pytest.approx(volume, rel=rel))
    assert solid.manifold.status().name == "NoError"
    assert (solid.repair.actions == ()) == (rung == "as-is")
    assert solid.manifold.bounding_box()[2] == 0


def test_a_clean_mesh_is_left_alone() -> None:
    ball = sphere(10.0)
    ball[0][:, 2] += 10
    ball[0][:, 2] -= ball[0][:, 2].min()
    solid = repair(model(ball))
    assert solid.repair.rung == "as-is"
    vertices, faces = arrays(solid.manifold)
    assert sorted(map(tuple, vertices)) == sorted(map(tuple, ball[0]))
    assert len(faces) == len(ball[1])
    assert (solid.repair.moved_max_mm, solid.repair.resolution_mm) == (0, None)


@pytest.mark.parametrize(
    ("parts", "rung", "volume", "count"),
    [
        pytest.param([HOLLOW], "as-is", 1000 - 216, (1, 1), id="a true void stays"),
        pytest.param([OUTER, box((20, 0, 0), (21, 1, 1))], "as-is", 1001, (2, 0), id="apart"),
        pytest.param([HOLLOW, box((4, 4, 4), (6, 6, 6))], "as-is", 792, (2, 1), id="floating"),
        pytest.param([OUTER, box((5, 1, 1), (15, 9, 9))], "union", 1320, (1, 0), id="overlapping"),
        pytest.param([OUTER, box((2, 2, 2), (8, 8, 8))], "union", 1000, (1, 0), id="swallowed"),
        pytest.param(
            [HOLLOW, box((5, 3, 3), (15, 7, 7))], "union", 784 + 3 * 16 + 5 * 16, (1, 1),
            id="reaching into a void",
        ),
        pytest.param([inside_out(OUTER)], "union", 1000, (1, 0), id="inside out"),
        pytest.param([inside_out(HOLLOW)], "union", 784, (1, 1), id="inside out with its void"),
        pytest.param(
            [OUTER, inside_out(box((20, 0, 0), (21, 1, 1)))], "union", 1001, (2, 0),
            id="one of two inside out",
        ),
        pytest.param(
            [HOLLOW, inside_out(box((4, 4, 4), (6, 6, 6)))], "union", 792, (2, 1),
            id="inside out in a void",
        ),
        pytest.param(
            [OUTER, (np.array([[3.0, 3, 12], [4, 3, 12], [3, 4, 12]]), np.array([[0, 1, 2]]))],
            "union", 1000, (1, 0), id="a scrap beside it",
        ),
        pytest.param(
            [OUTER, box((5, 5, 11), (5 + 1e-4, 5 + 1e-4, 11 + 1e-4))], "union", 1000, (1, 0),
            id="dust beside it",
        ),
    ],
)  # fmt: skip
def test_shells(parts: list[Any], rung: str, volume: float, count: tuple[int, int]) -> None:
    solid = repair(model(joined(*parts)))
    check(solid, rung, volume)
    solids, voids = shells(solid.manifold)
    assert (len(solids), len(voids)) == count
    assert solid.repair.moved_max_mm < 1e-9


@examples(15)
@given(st.integers(0, 2**31))
def test_boxes_at_random_unite_to_their_measure(seed: int) -> None:
    """Boxes on whole millimetres: the union is counted cell by cell."""
    rng = np.random.default_rng(seed)
    low = rng.integers(0, 7, (6, 3))
    high = low + rng.integers(1, 4, (6, 3))
    low[0, 2] = 0
    cells = np.zeros((10, 10, 10), dtype=bool)
    for a, b in zip(low, high, strict=True):
        cells[a[0] : b[0], a[1] : b[1], a[2] : b[2]] = True
    mesh = joined(*(box(tuple(a), tuple(b)) for a, b in zip(low, high, strict=True)))
    solid = repair(model(mesh))
    assert solid.repair.rung in ("as-is", "union")
    assert solid.manifold.volume() == pytest.approx(int(cells.sum()), rel=1e-9)


def test_faces_turned_the_wrong_way_are_turned_back() -> None:
    vertices, faces = sphere(10.0)
    vertices[:, 2] -= vertices[:, 2].min()
    volume = repair(model((vertices, faces))).manifold.volume()
    wrong = faces.copy()
    some = np.random.default_rng(5).choice(len(faces), len(faces) // 5, replace=False)
    wrong[some] = wrong[some][:, ::-1]
    solid = repair(model((vertices, wrong)))
    check(solid, "union", volume)
    assert f"Turned {len(some)} faces" in solid.repair.actions[0]


def test_a_missing_face_is_filled_without_moving_the_rest() -> None:
    vertices, faces = sphere(10.0)
    vertices[:, 2] -= vertices[:, 2].min()
    solid = repair(model((vertices, np.delete(faces, 100, axis=0))))
    check(solid, "meshlab", repair(model((vertices, faces))).manifold.volume(), rel=1e-6)
    assert len(arrays(solid.manifold)[1]) == len(faces)
    assert solid.repair.moved_max_mm < 1e-9


def test_an_open_box_is_closed_flat() -> None:
    vertices, faces = OUTER
    check(repair(model((vertices, faces[2:]))), "meshlab", 1000)


def test_a_self_intersecting_shell_is_made_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tube swept along a figure of eight: one shell, which no boolean takes apart."""
    monkeypatch.setattr(remesh, "CELLS", 120)
    turns, around = 120, 24
    t = np.linspace(0, 2 * np.pi, turns, endpoint=False)
    path = np.column_stack([30 * np.sin(t), 15 * np.sin(2 * t), np.zeros(turns)])
    along = np.roll(path, -1, axis=0) - np.roll(path, 1, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    aside = np.column_stack([-along[:, 1], along[:, 0], np.zeros(turns)])
    phi = np.linspace(0, 2 * np.pi, around, endpoint=False)
    ring = np.cos(phi)[None, :, None] * aside[:, None] + np.sin(phi)[None, :, None] * (0, 0, 1)
    vertices = (path[:, None] + 5 * ring).reshape(-1, 3)
    vertices[:, 2] -= vertices[:, 2].min()
    i, j = np.meshgrid(np.arange(turns), np.arange(around), indexing="ij")
    a, b = i * around + j, (i + 1) % turns * around + j
    c, d = (i + 1) % turns * around + (j + 1) % around, i * around + (j + 1) % around
    faces = np.vstack(
        [np.stack([a, c, b], -1).reshape(-1, 3), np.stack([a, d, c], -1).reshape(-1, 3)]
    )
    solid = repair(model((vertices, faces)))
    reference = Reference.of(vertices, faces)
    assert solid.repair.rung == "remesh"
    pitch = solid.repair.resolution_mm
    assert pitch == pytest.approx(np.ptp(vertices, axis=0).max() / 120)
    assert solid.repair.moved_max_mm < pitch
    assert solid.manifold.volume() == pytest.approx(reference.volume_mm3, rel=0.02)


@pytest.mark.parametrize("cut", [0.0, 0.3])
def test_remesh_keeps_a_ball_a_ball_open_or_not(
    monkeypatch: pytest.MonkeyPatch, cut: float
) -> None:
    monkeypatch.setattr(remesh, "CELLS", 100)
    vertices, faces = sphere(10.0)
    kept = faces[vertices[faces][:, :, 0].max(axis=1) < 10 * (1 - cut)] if cut else faces
    found = remeshed(vertices, kept)
    assert isinstance(found, Candidate)
    corners, _ = arrays(found.manifold)
    radius = np.linalg.norm(corners, axis=1)
    cell = 20 / 100
    on_ball = corners[:, 0] < 10 * (1 - cut) - 1
    assert np.abs(radius[on_ball] - 10).max() < cell
    assert len(bodies(found.manifold)) == 1
    if cut:  # the cap is closed about where it was cut, not bulging out or in
        lid = corners[(corners[:, 0] > 5.5) & (radius < 8.5)]
        assert np.abs(lid[:, 0] - 7).max() < 0.8


@pytest.mark.parametrize(
    ("mesh", "fact"),
    [
        (box((0, 0, 0), (10, 10, 0)), "flat: it has no extent along z"),
        ((OUTER[0], np.vstack([OUTER[1], inside_out(OUTER)[1]])), "encloses no volume"),
        ((OUTER[0], OUTER[1][:4]), "open sheet|cannot be made a solid|encloses no volume"),
    ],
)
def test_what_no_rung_can_mend(mesh: Any, fact: str) -> None:
    with pytest.raises(GeometryError, match=fact) as caught:
        repair(model(mesh))
    assert caught.value.exit_code == 4
    assert caught.value.hint


def test_the_solid_is_seated_when_what_it_stood_on_is_left_out() -> None:
    scrap = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), np.array([[0, 1, 2]]))
    solid = repair(model(joined(box((0, 0, 5), (10, 10, 15)), scrap)))
    assert solid.manifold.bounding_box()[2] == 0
    assert solid.placement[2, 3] == -5


def test_repairing_twice_gives_the_same_bytes() -> None:
    mesh = joined(OUTER, box((5, 1, 1), (15, 9, 9)))
    first, second = (arrays(repair(model(mesh)).manifold) for _ in range(2))
    assert first[0].tobytes() == second[0].tobytes()
    assert first[1].tobytes() == second[1].tobytes()


class Child:
    """Stands in for the process that runs the filters."""

    def __init__(self, status: int, stderr: str = "", hangs: bool = False) -> None:
        self.status, self.stderr, self.hangs, self.calls = status, stderr, hangs, 0

    def __call__(self, command: list[str], timeout_s: float) -> Ended:
        self.calls += 1
        if self.hangs:
            raise HungError(f"was stopped after {timeout_s:g} s without a result")
        return Ended(self.status, "", self.stderr)


@pytest.mark.parametrize(
    ("child", "calls", "said"),
    [
        (Child(meshlab_child.CANNOT_LOAD, "libGL.so.1: no such file"), 1, "libGL.so.1"),
        (Child(-11), len(meshlab_child.RECIPES), None),
        (Child(0, hangs=True), 1, "was stopped after"),  # the next would hang as long
        (Child(meshlab_child.REFUSED, "odd mesh"), len(meshlab_child.RECIPES), None),
    ],
)
def test_a_child_that_fails_is_skipped_and_said_so(
    monkeypatch: pytest.MonkeyPatch, child: Child, calls: int, said: str | None
) -> None:
    monkeypatch.setattr(meshlab, "run", child)
    monkeypatch.setattr(remesh, "CELLS", 50)
    vertices, faces = OUTER
    solid = repair(model((vertices, faces[1:])))
    assert solid.repair.rung == "remesh"
    assert solid.manifold.volume() == pytest.approx(1000, rel=0.03)
    assert child.calls == calls
    skipped = [action for action in solid.repair.actions if "Skipped" in action]
    assert (skipped == []) if said is None else (said in skipped[0])


def test_pymeshlab_stays_out_of_this_process() -> None:
    code = "import printprep.mesh.repair, sys; print('pymeshlab' in sys.modules)"
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, encoding="utf-8", check=True
    )
    assert done.stdout.strip() == "False"
